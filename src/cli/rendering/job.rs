//! Renders an image and writes it, or stops and leaves a checkpoint for a later render.

use crate::files::output::{Output, finished};
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::{self, Failure};
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::resume::{self, ResumedImage};
use crate::rendering::stats::Stats;
use crate::rendering::unfinished;
use std::io::{self, BufWriter};
use std::mem::{replace, take};
use std::ops::Range;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;
use tabray_core::output::packing::PIECE;
use tabray_core::output::picture::Format;
use tabray_core::render::Levels;
use tabray_core::render::flaws::{BudgetCuts, FarPaths, Flaws, Undecided};
use tabray_core::render::limits::{MAX_DIST, MAX_RAYS, MAX_TREE};
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::{Proofs, RayStats};
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::render::tiles::{BAND, Band, Tiles};
use tabray_core::scene::model::Model;
use tabray_core::text::{count, short};
use tabray_core::world::certify::Doubt;
use tabray_core::world::rules::Rules;

/// The maximum number of blank pixels that are written in place of missing ones. If more are missing, the file ends at
/// the first row of which nothing is rendered.
const MOST_BLANK: usize = 1 << 24;

/// The maximum number of reasons that are listed why pixels could not be decided.
const MOST_REASONS: usize = 4;

/// A part of a plan's image, and how it is rendered.
pub struct Job<'a> {
    pub plan: &'a Plan<'a>,
    pub region: &'a Region,
    pub renderer: &'a Renderer,
    pub format: Format,
    /// The path of the image.
    pub path: &'a Path,
    /// The texts that a PNG records about how the image was made.
    pub made: &'a [(&'static str, String)],
    /// The maximum number of pixels in memory at one time.
    pub at_once: usize,
    pub stop: &'a Stop,
    /// The statistics to fill in, if they are wanted.
    pub stats: Option<&'a Stats>,
}

impl Job<'_> {
    /// Renders what a checkpoint does not have, and writes the image to its path. If the render is stopped, the program
    /// ends with what is done, because threads may still be at work.
    /// Returns the levels of the image, and the rays whose paths were too long under the notes' rules.
    pub fn run(&self, output: Output, begun: Option<ResumedImage>) -> Result<(Levels, FarPaths), Failure> {
        let progress = Progress::new(self.region.rows.len());
        let (flaws, proofs) = (Mutex::new(Flaws::default()), Mutex::new(Proofs::default()));
        let flawed = |part: Flaws| flaws.lock().unwrap_or_else(PoisonError::into_inner).add(&part);
        let sum = self.stats.map(|stats| &stats.tally);
        let add = |tally: RayStats| {
            proofs.lock().unwrap_or_else(PoisonError::into_inner).add(tally.proofs);
            sum.iter().for_each(|sum| sum.add(&tally));
            flawed(tally.flaws);
        };
        let overseer = RenderCallbacks { stops: &|| self.stop.is_due(), row: &|| progress.step() };
        let (plan, renders) = (self.plan, (self.renderer, self.plan));
        let (plain, counted): (&(dyn Fn(Flaws) + Sync), &(dyn Fn(RayStats) + Sync)) = (&flawed, &add);
        match output {
            Output::File(..) => self.stop.begin(),
            Output::Standard | Output::Special(_) => self.stop.begin_sending(),
        }
        thread::scope(|scope| {
            let fill = |band: &mut Band| match self.stats {
                None if plan.camera.certain => unfinished::fill(scope, renders, band, overseer, counted),
                None => unfinished::fill(scope, renders, band, overseer, plain),
                Some(stats) => stats.timed(|| unfinished::fill(scope, renders, band, overseer, counted)),
            };
            let outcome = self.write(output, begun, &progress, fill);
            progress.end();
            let flaws = take(&mut *flaws.lock().unwrap_or_else(PoisonError::into_inner));
            warn_of(&flaws, plan.model);
            report_proofs(take(&mut proofs.lock().unwrap_or_else(PoisonError::into_inner)), plan);
            match outcome {
                Err(failure) if self.stop.is_due() => failure::end(&failure),
                outcome => outcome.map(|levels| (levels, flaws.far)),
            }
        })
    }

    fn write(
        &self,
        output: Output,
        mut begun: Option<ResumedImage>,
        progress: &Progress,
        fill: impl Fn(&mut Band),
    ) -> Result<Levels, Failure> {
        let Region { columns, rows } = self.region;
        let mut tiles = Tiles::none(self.region.size());
        let (mut broken, mut told, mut is_cut) = (None, false, false);
        let mut levels = Levels::default();
        let mut out = BufWriter::with_capacity(1 << 16, output);
        let mut writing = None;
        let bands = Band::split(columns, rows, self.at_once).flat_map(|band| {
            if let Some(since) = writing.take() {
                self.stop.add_writing_time(Instant::elapsed(&since));
            }
            let is_blank = self.stop.is_due() && begun.as_ref().is_none_or(ResumedImage::is_over);
            if is_blank && (rows.end - band.start) * columns.len() > MOST_BLANK {
                is_cut = true;
                self.report_once(&mut told, progress);
                // One row more, so that the compressor writes the rows before it.
                return vec![Ok(vec![0; 3 * columns.len()]), Err(io::ErrorKind::Other.into())];
            }
            let mut band = match self.band(band, begun.as_mut()) {
                Ok(band) => band,
                Err(failure) => {
                    broken = Some(failure);
                    return vec![Err(io::ErrorKind::InvalidData.into())];
                }
            };
            fill(&mut band);
            tiles.add(&band);
            if !band.is_whole() {
                self.report_once(&mut told, progress);
            }
            writing = Some(Instant::now());
            let bytes = band.bytes(PIECE);
            bytes.iter().for_each(|bytes| levels.add(bytes));
            bytes.into_iter().map(Ok).collect()
        });
        // Pieces that are compressed together are in memory together.
        let renderer = (self.at_once == BAND).then_some(self.renderer);
        let written = self.format.write_on(renderer, self.made, &mut out, self.region.size(), bands);
        match (broken, written) {
            (Some(failure), _) => Err(failure),
            (None, Err(error)) if is_cut && error.kind() == io::ErrorKind::Other => {
                Err(self.leave(out, &tiles, tiles.rows_begun()))
            }
            (None, Ok(())) if !tiles.is_whole() => Err(self.leave(out, &tiles, rows.len())),
            (None, written) => {
                finished(self.path, written, out)?;
                begun.map_or(Ok(()), ResumedImage::remove)?;
                Ok(levels)
            }
        }
    }

    /// Reports why the render stops, once.
    fn report_once(&self, told: &mut bool, progress: &Progress) {
        if !replace(told, true) {
            progress.end();
            self.stop.report();
        }
    }

    /// Makes a band, filled with the pixels of a checkpoint.
    fn band(&self, rows: Range<usize>, begun: Option<&mut ResumedImage>) -> Result<Band, Failure> {
        let columns = self.region.columns.clone();
        memory::refuse_too_large(3 * rows.len() * columns.len(), "the image")?;
        let band = Band::blank(columns, rows);
        begun.map_or(Ok(()), |begun| begun.fill(&band))?;
        Ok(band)
    }

    /// Writes an unfinished image to its path, and reports it: the render was stopped, unless that fails. `out` contains `rows` rows of it, black where nothing is
    /// rendered.
    fn leave(&self, out: BufWriter<Output>, tiles: &Tiles, rows: usize) -> Failure {
        self.left(out, tiles, rows).err().unwrap_or(Failure::Stopped)
    }

    fn left(&self, out: BufWriter<Output>, tiles: &Tiles, rows: usize) -> Result<(), Failure> {
        let output =
            out.into_inner().map_err(|error| Failure::cannot_write(self.path, &error.into_error()))?;
        let [width, height] = self.region.size();
        // Rounded down, so that an unfinished image does not show 100 %.
        let share = (1000.0 * tiles.pixels() as f64 / (width * height) as f64).floor() / 10.0;
        messages::note(&match &output {
            Output::File(..) if tiles.pixels() == 0 => {
                "nothing has been rendered yet, and nothing is written".to_owned()
            }
            Output::File(..) => {
                let checkpoint = resume::leave(
                    self.plan.model,
                    self.region,
                    (self.path, self.format),
                    output,
                    (tiles, rows),
                )?;
                let [picture, checkpoint] = [self.path, &checkpoint].map(Path::display);
                format!(
                    "wrote {share:.1} % of {picture}, and {checkpoint}, from which `--resume` renders the rest"
                )
            }
            Output::Standard | Output::Special(_) => {
                let rest = if rows < height { "missing" } else { "black" };
                format!(
                    "{share:.1} % of the image is rendered, and the rest is {rest}; only files can be resumed"
                )
            }
        });
        Ok(())
    }
}

/// Tells how many pixels are certified, and how much the others may be off, if anything is proven.
pub fn report_proofs(proofs: Proofs, plan: &Plan) {
    let (Some(error), 1..) = (plan.camera.adaptive.and_then(|adaptive| adaptive.error), proofs.pixels())
    else {
        return;
    };
    // Rounded down, so that an open pixel does not show 100 %; the bounds are rounded up.
    let share = (10000.0 * proofs.certified as f64 / proofs.pixels() as f64).floor() / 100.0;
    let levels = |error: f64| short((255.0 * 1000.0 * error).ceil() / 1000.0);
    let rest = match proofs.open {
        0 => String::new(),
        open => format!(
            "; the other {} may be off by up to {} levels, by {} on average",
            count(open as usize, "pixel"),
            levels(proofs.most),
            levels(proofs.mean()),
        ),
    };
    messages::note(&format!(
        "{share} % of the pixels are certain to be within {} of 255 levels{rest}; the bytes are rounded down from that",
        short(255.0 * error)
    ));
}

/// Warns of pixels with primary rays that used up their ray budget or could not be decided, if there are any.
pub fn warn_of(Flaws { cuts, undecided, .. }: &Flaws, model: &Model) {
    if cuts.pixels > 0 {
        warn_of_cuts(cuts, model.camera.value.rules);
    }
    if undecided.pixels() > 0 {
        warn_of_undecided(undecided, model);
    }
}

/// Says how many rays lack light because paths end under the notes' rules, if there are any.
pub fn tell_of_far(FarPaths { rays, of }: FarPaths) {
    if rays > 0 {
        messages::note(&format!(
            "light in mirrors and glass ends after {MAX_DIST} units under the notes' rules, and is black beyond: in \
             {rays} of {of} rays from the viewer; `rules free` in the camera has no such end"
        ));
    }
}

fn warn_of_undecided(undecided: &Undecided, model: &Model) {
    let of = |((object, doubt), pixels): (&(usize, Doubt), &u64)| {
        let why = format!("`{}` {doubt}", model.objects[*object].args.name());
        if undecided.0.len() > 1 { format!("{why} ({pixels})") } else { why }
    };
    let reasons: Vec<_> = undecided.0.iter().map(of).collect();
    let (named, others) = reasons.split_at(reasons.len().min(MOST_REASONS));
    let more = if others.is_empty() { String::new() } else { format!("; and {} more", others.len()) };
    messages::warning(
        &format!(
            "{} could not be decided: {}{more}",
            count(undecided.pixels() as usize, "pixel"),
            named.join("; ")
        ),
        Some(
            "a surface that rays touch but do not cross may be missing there, for example where a factor of a \
             formula is squared; `--aov undecided` shows these pixels",
        ),
    );
}

fn warn_of_cuts(cuts: &BudgetCuts, rules: Rules) {
    let levels = 255.0 * cuts.most;
    let most = match (levels.is_finite(), rules) {
        (true, Rules::Notes) => format!("off by at most {} of 255 levels", short(levels)),
        (true, Rules::Free) => format!("with bounds of up to {} of 255 levels", short(levels)),
        (false, _) => "off by an unknown amount: nothing bounds the light beyond".to_owned(),
    };
    let budget = match rules {
        Rules::Notes => format!("the work of {MAX_RAYS} simple rays for each primary ray"),
        Rules::Free => {
            format!(
                "{MAX_TREE} rays for each pixel, shared by its samples, and the work of {MAX_RAYS} simple ones"
            )
        }
    };
    messages::warning(
        &format!("{} cut off at the ray budget ({budget}), {most}", count(cuts.pixels as usize, "pixel")),
        Some(
            "mirrors or glass spawn too many rays, or rays that are too costly: a lower `specular` or `transparency` \
            ends them sooner",
        ),
    );
}
