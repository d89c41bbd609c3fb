//! Explanations of an image's pixel by `probe`, for reports: from this program, and from an older one.

use std::path::Path;
use std::process::{Command, Stdio};
use tabray_cli::options::set;
use tabray_core::output::compare::Pixel;
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_tools::probe;
use tabray_tools::threads::renderer_with;

/// An explanation of how a pixel got its colour, as far as possible.
pub struct Explanation {
    /// The image to which the pixel belongs, and the program that explains it.
    pub title: String,
    /// The output of `probe`, or the reason why there is none.
    pub text: String,
}

/// A pixel of an image of a scene.
pub struct Place<'p> {
    /// The scene's file.
    pub scene: &'p Path,
    /// The values that are set beside its text.
    pub set: &'p set::Args,
    /// The scene as it is now.
    pub model: Model,
    /// The width and the height of the image in pixels; it may be smaller than the scene says.
    pub size: [u32; 2],
    /// The pixel.
    pub pixel: Pixel,
}

impl Place<'_> {
    /// Explains the colour of the pixel in the new image and, if an older program is given, in the old one.
    pub fn explained(self, before: Option<&Path>) -> Vec<Explanation> {
        let Pixel { old, new, .. } = self.pixel;
        let scene = text::shown(self.scene);
        let by_another = before.map(|program| {
            let title = format!("Before, by {}", text::shown(program));
            explanation(title, self.by_another(program), old)
        });
        let title = format!("After: {scene}");
        by_another.into_iter().chain([explanation(title, self.by_this(), new)]).collect()
    }

    fn by_this(self) -> Result<String, String> {
        let mut plan = Plan::new(&self.model);
        plan.camera.pixels = self.size();
        let (x, y) = (self.pixel.x as usize, self.pixel.y as usize);
        let mut out = Vec::new();
        renderer_with(1)
            .and_then(|renderer| renderer.run(|| probe::pixel(&plan, x, y, &mut out)))
            .map_err(|error| text::reason(&error))?;
        Ok(String::from_utf8_lossy(&out).into_owned())
    }

    fn by_another(&self, program: &Path) -> Result<String, String> {
        if self.model.camera.value.pixels != self.size() {
            return Err("the image does not have the size in its scene".to_owned());
        }
        let output = Command::new(program)
            .arg("probe")
            .arg(self.scene)
            .args(self.set.values.iter().flat_map(|value| ["--set", value]))
            .args([self.pixel.x.to_string(), self.pixel.y.to_string()])
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("cannot start `{}`: {}", text::shown(program), text::reason(&error)))?;
        if !output.status.success() {
            return Err(format!(
                "the program says\n\n{}",
                String::from_utf8_lossy(&output.stderr).trim_end()
            ));
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn size(&self) -> [usize; 2] {
        self.size.map(|side| side as usize)
    }
}

/// Makes an explanation of a pixel with these bytes; says so if the explanation arrives at other bytes.
fn explanation(title: String, told: Result<String, String>, [r, g, b]: [u8; 3]) -> Explanation {
    let bytes = format!("({r}, {g}, {b})");
    let text = match told {
        Ok(text) if text.trim_end().ends_with(&bytes) => text,
        Ok(text) => format!("the image has {bytes} here, so it was not made like this:\n\n{text}"),
        Err(reason) => format!("no explanation: {reason}"),
    };
    Explanation { title, text }
}
