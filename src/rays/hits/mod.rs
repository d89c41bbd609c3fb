//! Finds the hits of rays: rays are read as text, CSV, JSON lines or a NumPy array, and answers are written as CSV,
//! JSON lines or a NumPy array.

pub mod answers;
pub mod columns;
pub mod hard;
pub mod judge;
mod npy;
pub mod rays;
pub mod starts;
pub mod theirs;

use answers::AnswerFormat;
use columns::Answered;
use rayon::prelude::*;
use rays::{BadRay, RayReader, RayRow};
use std::io::{self, Write};
use tabray_core::geometry::ray_packet::PACKET_SIZE;
use tabray_core::query::{Crossing, Query, QueryRay};
use tabray_core::render::Renderer;

/// The number of rays that are answered before any answer is written: enough for all threads, and little memory.
const TOGETHER: usize = 64 * PACKET_SIZE;

/// The maximum number of bad rays that are reported.
const TOLD: usize = 10;

/// The questions about the rays.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Whether nothing is proven.
    pub fast: bool,
    /// Whether bounds are narrowed with 237 bits.
    pub tight: bool,
    /// Whether each ray has an answer for each surface that it crosses, and one for what is behind the last.
    pub all: bool,
    /// Whether it only matters that something is hit, not what.
    pub any: bool,
    /// The default end of rays, in the unit of their t.
    pub t_max: f64,
    /// Whether invalid rays are left out.
    pub skip_bad: bool,
}

impl Default for Asked {
    fn default() -> Self {
        Self { fast: false, tight: false, all: false, any: false, t_max: f64::INFINITY, skip_bad: false }
    }
}

/// The numbers of rays that were answered, and of those that were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// The number of answered rays.
    pub answered: u64,
    /// The number of invalid rays.
    pub bad: u64,
}

/// The reason why answers end early.
#[derive(Debug)]
pub enum Ended {
    /// Some rays are invalid; the first of them.
    Bad(Vec<BadRay>),
    /// The answers cannot be written.
    Unwritten(io::Error),
}

/// A ray of a query, with the t of its end.
pub type Ray = (QueryRay, f64);

/// Answers all rays of a reader, in their order. The answers depend on the rays alone, not on the threads. `step`
/// gets the number of rays that are done.
///
/// # Errors
/// Returns the first invalid rays, unless `skip_bad` is set, and the errors of the output.
pub fn read(
    renderer: &Renderer,
    query: &Query,
    asked: &Asked,
    rays: &mut RayReader,
    (format, out): (&AnswerFormat, &mut dyn Write),
    step: &mut dyn FnMut(usize),
) -> Result<Tally, Ended> {
    let (mut tally, mut bad) = (Tally::default(), Vec::new());
    loop {
        let (mut part, mut is_over): (Vec<Ray>, bool) = (Vec::new(), false);
        // A program that asks through a pipe may wait for an answer before it sends the next ray.
        while part.len() < TOGETHER && bad.len() < TOLD && (part.is_empty() || rays.has_more()) {
            let row =
                rays.next().map(|row| row.and_then(|row| placed(query, row).map_err(|why| rays.fault(why))));
            match row {
                None => {
                    is_over = true;
                    break;
                }
                Some(Ok((ray, t_max))) => part.push((ray, t_max.unwrap_or(asked.t_max))),
                Some(Err(fault)) => {
                    tally.bad += 1;
                    if !asked.skip_bad || fault.is_last {
                        bad.push(fault);
                    }
                }
            }
        }
        if !bad.is_empty() {
            return Err(Ended::Bad(bad));
        }
        let first = tally.answered;
        let answered =
            answer(renderer, query, asked, (first, &part), (format, out)).and_then(|()| out.flush());
        answered.map_err(Ended::Unwritten)?;
        tally.answered += part.len() as u64;
        step(part.len());
        if is_over {
            return Ok(tally);
        }
    }
}

/// Returns a ray with the surface that it leaves, and its end.
fn placed(query: &Query, RayRow { ray, t_max, leaves }: RayRow) -> Result<(QueryRay, Option<f64>), String> {
    let Some([object, surface]) = leaves else { return Ok((ray, t_max)) };
    let start = query.start(object, surface);
    let start = start.ok_or_else(|| format!("the scene has no object {object} that it could leave"))?;
    Ok((ray.leaving(start), t_max))
}

/// Answers the rays through the pixels of a scene's camera, row by row from the top.
///
/// # Errors
/// Returns the errors of the output.
pub fn of_camera(
    renderer: &Renderer,
    query: &Query,
    asked: &Asked,
    (format, out): (&AnswerFormat, &mut dyn Write),
    step: &mut dyn FnMut(usize),
) -> io::Result<Tally> {
    let [width, height] = query.model().camera.value.pixels;
    let mut tally = Tally::default();
    for y in (0..height).rev() {
        let part: Vec<Ray> = (0..width).map(|x| (query.camera_ray(x, y), asked.t_max)).collect();
        answer(renderer, query, asked, (tally.answered, &part), (format, out))?;
        tally.answered += width as u64;
        step(width);
    }
    Ok(tally)
}

/// Answers rays; `first` is the number of the first ray.
fn answer(
    renderer: &Renderer,
    query: &Query,
    asked: &Asked,
    (first, rays): (u64, &[Ray]),
    (format, out): (&AnswerFormat, &mut dyn Write),
) -> io::Result<()> {
    let packet = |(index, rays): (usize, &[Ray])| -> io::Result<Vec<u8>> {
        format.written(&answers(query, asked, first + (index * PACKET_SIZE) as u64, rays))
    };
    let packets: Vec<_> = renderer.run(|| rays.par_chunks(PACKET_SIZE).enumerate().map(packet).collect());
    packets.into_iter().try_for_each(|bytes| out.write_all(&bytes?))
}

/// Returns the answers to a packet of rays; `first` is the number of the first ray.
pub fn answers<'q, 'm>(
    query: &'q Query<'m>,
    asked: &Asked,
    first: u64,
    rays: &[Ray],
) -> Vec<Answered<'q, 'm>> {
    let with_surface = |of: &QueryRay, ray: Option<u64>, Crossing { answer, enters }: Crossing| {
        let surface = query.surroundings(of, &answer);
        Answered { query, ray, answer, enters, surface }
    };
    if asked.all {
        let of_ray = |(number, (ray, end)): (u64, &Ray)| {
            let crossings = query.crossings(ray, *end, asked.tight).into_iter();
            crossings.map(|one| with_surface(ray, Some(number), one)).collect::<Vec<_>>()
        };
        return (first..).zip(rays).flat_map(of_ray).collect();
    }
    let of: Vec<_> = rays.iter().map(|(ray, _)| ray.clone()).collect();
    let answers = if asked.fast { query.traced(&of) } else { query.proven(&of, asked.tight) };
    let ended = answers.into_iter().zip(rays).map(|(answer, (ray, end))| {
        let answer = if asked.any { answer.any_within(*end) } else { answer.within(*end) };
        with_surface(ray, None, Crossing { answer, enters: None })
    });
    ended.collect()
}
