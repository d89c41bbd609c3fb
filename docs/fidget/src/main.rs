//! Renders a formula with fidget on one thread, as docs/surfaces.py asks it to: `fidget-peer FORMULA.vm WIDTH HEIGHT OUT.ppm`,
//! and the three columns of the matrix from fidget's world to the formula's coordinates, nine numbers.

use fidget::context::Context;
use fidget::jit::{JitFunction, JitShape};
use fidget::raster::VoxelRenderConfig;
use fidget::render::{RenderHints, VoxelSize};
use nalgebra::{Matrix3, Matrix4};
use std::error::Error;
use std::fs::{self, File};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [formula, width, height, out, matrix @ ..] = &args[..] else {
        return Err("too few arguments".into());
    };
    let (width, height) = (width.parse()?, height.parse()?);
    let numbers = matrix.iter().map(|number| number.parse()).collect::<Result<Vec<f32>, _>>()?;
    let turned: Matrix4<f32> = Matrix3::from_column_slice(&numbers).to_homogeneous();
    let (context, root) = Context::from_text(File::open(formula)?)?;
    let config = VoxelRenderConfig {
        image_size: VoxelSize::new(width, height, height),
        world_to_model: turned,
        tile_sizes: JitFunction::tile_sizes_3d(),
        threads: None,
        ..VoxelRenderConfig::default()
    };
    let pixels = config.run(JitShape::new(&context, root)?).ok_or("no image")?;
    let mut bytes = format!("P6\n{width} {height}\n255\n").into_bytes();
    bytes.extend(pixels.iter().flat_map(|pixel| if pixel.depth > 0.0 { pixel.to_color() } else { [0; 3] }));
    Ok(fs::write(out, bytes)?)
}
