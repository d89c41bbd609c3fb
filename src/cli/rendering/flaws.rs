//! What is told of an image that is rendered: what is wrong with its pixels, and what is proven of them.

use crate::process::messages;
use tabray_core::render::flaws::{BudgetCuts, FarPaths, Flaws, Undecided, UndecidedPixels};
use tabray_core::render::limits::{MAX_DIST, MAX_RAYS, of_pixel};
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::Proofs;
use tabray_core::scene::model::Model;
use tabray_core::text::{count, short};
use tabray_core::world::certify::Doubt;
use tabray_core::world::rules::Rules;
use tabray_core::world::sensor::Sensor;

/// The maximum number of reasons that are listed why pixels could not be decided.
const MAX_REASONS: usize = 4;

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
    let rounding = match plan.camera.rules {
        Rules::Notes => "; the bytes are rounded down from that",
        Rules::Free => "",
    };
    messages::note(&format!(
        "{share} % of the pixels are certain to be within {} of 255 levels{rest}{rounding}",
        short(255.0 * error)
    ));
}

/// Warns of pixels with primary rays that used up their ray budget or could not be decided, if there are any.
pub fn warn_of(Flaws { cuts, undecided, .. }: &Flaws, model: &Model) {
    if cuts.pixels > 0 {
        warn_of_cuts(cuts, &model.camera.value);
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
    let of = |((object, doubt), pixels): (&(usize, Doubt), &UndecidedPixels)| {
        let place = |at: f64| format!("{}{}", if at < 0.0 { "-" } else { "" }, short(at.abs()));
        let at = pixels.at.to_array().map(place).join(" ");
        let why = format!("`{}` {doubt}, as at {at}", model.objects[*object].args.name());
        if undecided.0.len() > 1 { format!("{why} ({})", pixels.count) } else { why }
    };
    let reasons: Vec<_> = undecided.0.iter().map(of).collect();
    let (named, others) = reasons.split_at(reasons.len().min(MAX_REASONS));
    let more = if others.is_empty() { String::new() } else { format!("; and {} more", others.len()) };
    messages::warning(
        &format!(
            "{} could not be decided: {}{more}",
            count(undecided.pixels() as usize, "pixel"),
            named.join("; ")
        ),
        Some(&format!("{}; `--aov undecided` shows these pixels", cure(undecided))),
    );
}

/// Returns what may be wrong at pixels that are not decided, and what would be decided.
fn cure(undecided: &Undecided) -> &'static str {
    let any = |is: fn(&Doubt) -> bool| undecided.0.keys().any(|(_, doubt)| is(doubt));
    if any(|doubt| *doubt == Doubt::Touched) {
        "a surface that rays touch but do not cross may be missing there, for example where a factor of a formula is \
         squared"
    } else if any(|doubt| matches!(doubt, Doubt::Undefined(_) | Doubt::Jumps(Some(_)) | Doubt::Long(Some(_))))
    {
        "what is drawn there is not proven; a formula that is defined and continuous there can be decided"
    } else {
        "what is drawn there is not proven"
    }
}

fn warn_of_cuts(cuts: &BudgetCuts, &Sensor { rules, bounces, .. }: &Sensor) {
    let [rays, work] = of_pixel(bounces);
    let levels = 255.0 * cuts.most;
    let most = match (levels.is_finite(), rules) {
        (true, Rules::Notes) => format!("off by at most {} of 255 levels", short(levels)),
        (true, Rules::Free) => format!("with bounds of up to {} of 255 levels", short(levels)),
        (false, _) => "off by an unknown amount: nothing bounds the light beyond".to_owned(),
    };
    let budget = match rules {
        Rules::Notes => format!("each ray from the viewer may take the work of {MAX_RAYS} simple rays"),
        Rules::Free => format!(
            "the samples of a pixel together may take {rays} rays, and the work of {work} simple ones"
        ),
    };
    let pixels = count(cuts.pixels as usize, "pixel");
    messages::warning(
        &format!("{pixels} not finished, {most}: {budget}"),
        Some(
            "mirrors or glass spawn too many rays, or rays that are too costly: a lower `specular` or `transparency` \
            ends them sooner",
        ),
    );
}
