//! Renders an image and writes it, or stops and leaves what a later render can continue from.

use super::failure::Failure;
use super::messages;
use super::output::{Output, finished};
use super::progress::Progress;
use super::resume::{self, Begun};
use super::size::Part;
use super::stats::Stats;
use super::stop::Stop;
use crate::output::picture::Format;
use crate::render::limits::MAX_RAYS;
use crate::render::plan::Plan;
use crate::render::ray_stats::{Cuts, RayStats};
use crate::render::renderer::{Overseer, Renderer};
use crate::render::tiles::{Band, Tiles};
use crate::text::{count, short};
use std::io::{self, BufWriter};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A part of a plan's image, and how it is rendered.
pub struct Job<'a> {
    pub plan: &'a Plan<'a>,
    pub part: &'a Part,
    pub renderer: &'a Renderer,
    pub format: Format,
    /// The path of the image.
    pub path: &'a Path,
    /// How many pixels may be in memory at one time.
    pub band: usize,
    pub stop: &'a Stop,
    /// The statistics to fill in, if they are wanted.
    pub stats: Option<&'a Stats>,
}

impl Job<'_> {
    /// Renders what a checkpoint does not have, and puts the picture where it belongs.
    pub fn run(&self, output: Output, mut begun: Option<Begun>) -> Result<(), Failure> {
        let Part { columns, rows } = self.part;
        let progress = Progress::new(rows.len());
        let mut tiles = Tiles::none(self.part.size());
        let cuts = Mutex::new(Cuts::default());
        let (mut broken, mut told) = (None, false);
        let mut out = BufWriter::with_capacity(1 << 16, output);
        let bands = Band::split(columns, rows, self.band).map(|rows| {
            let mut band = Band::blank(columns.clone(), rows);
            if let Some(begun) = &mut begun
                && let Err(failure) = begun.fill(&mut band)
            {
                broken = Some(failure);
                return Err(io::ErrorKind::InvalidData.into());
            }
            self.fill(&mut band, &progress, &cuts);
            tiles.add(&band);
            if !band.is_whole() && !told {
                told = true;
                progress.end();
                self.stop.tell();
            }
            Ok(band.pixels.into_flattened())
        });
        let written = self.format.write(&mut out, self.part.size(), bands);
        progress.end();
        warn_of(cuts.into_inner().unwrap_or_else(PoisonError::into_inner));
        match broken {
            Some(failure) => Err(failure),
            None if written.is_ok() && !tiles.is_whole() => self.leave(out, &tiles),
            None => {
                finished(self.path, written, out)?;
                begun.map_or(Ok(()), Begun::remove)
            }
        }
    }

    fn fill(&self, band: &mut Band, progress: &Progress, cuts: &Mutex<Cuts>) {
        let cut = |part| cuts.lock().unwrap_or_else(PoisonError::into_inner).add(part);
        let overseer = Overseer { stops: &|| self.stop.is_due(), row: &|| progress.step() };
        match self.stats {
            None => self.renderer.fill(self.plan, band, overseer, &cut),
            Some(stats) => {
                let sum = &stats.tally;
                let add = |tally: RayStats| {
                    cut(tally.cuts);
                    sum.add(&tally);
                };
                stats.timed(|| self.renderer.fill(self.plan, band, overseer, &add));
            }
        }
    }

    /// Puts a part of the picture where it belongs, and says what is there. `out` has it, and black for the rest.
    fn leave(&self, out: BufWriter<Output>, tiles: &Tiles) -> Result<(), Failure> {
        let output =
            out.into_inner().map_err(|error| Failure::cannot_write(self.path, &error.into_error()))?;
        let [width, height] = self.part.size();
        // Rounded down, so that an unfinished image does not show 100 %.
        let share = (1000.0 * tiles.pixels() as f64 / (width * height) as f64).floor() / 10.0;
        messages::note(&match &output {
            Output::File(..) if tiles.pixels() == 0 => {
                "nothing has been rendered yet, and nothing is written".to_owned()
            }
            Output::File(..) => {
                let checkpoint =
                    resume::leave(self.plan.model, self.part, (self.path, self.format), output, tiles)?;
                let [picture, checkpoint] = [self.path, &checkpoint].map(Path::display);
                format!(
                    "wrote {share:.1} % of {picture}, and {checkpoint}, from which `--resume` renders the rest"
                )
            }
            Output::Standard | Output::Special(_) => {
                format!(
                    "{share:.1} % of the image is rendered, and the rest is black; only files can be resumed"
                )
            }
        });
        Err(Failure::Stopped)
    }
}

/// Warns of pixels that reached the limit on their number of rays, if there are any.
fn warn_of(cuts: Cuts) {
    if cuts.pixels == 0 {
        return;
    }
    let levels = 255.0 * cuts.most;
    let most = if levels.is_finite() {
        format!("off by at most {} of 255 levels", short(levels))
    } else {
        "off by an unknown amount: nothing bounds the light beyond".to_owned()
    };
    messages::warning(
        &format!(
            "{} cut off at {MAX_RAYS} rays for one primary ray, {most}",
            count(cuts.pixels as usize, "pixel")
        ),
        Some("mirrors or glass spawn too many rays: a lower `specular` or `transparency` ends them sooner"),
    );
}
