//! Small bodies. Their coordinates are exact in single precision.

use super::Model;

/// A cube from 0 to 1, of six squares.
pub fn cube() -> Model {
    let vertices = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    let sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]];
    Model { vertices: vertices.to_vec(), faces: sides.iter().map(|side| side.to_vec()).collect() }
}

/// A body between two equal polygons across z, whose corners run counterclockwise as seen from above.
fn prism(outline: &[[f32; 2]], [low, high]: [f32; 2]) -> Model {
    let count = outline.len();
    let at = |z: f32| outline.iter().map(move |[x, y]| [*x, *y, z]);
    let sides = (0..count).map(|from| {
        let to = (from + 1) % count;
        vec![from, to, count + to, count + from]
    });
    let ends = [(0..count).rev().collect(), (count..2 * count).collect()];
    Model { vertices: at(low).chain(at(high)).collect(), faces: ends.into_iter().chain(sides).collect() }
}

/// A crown of five corners, two of its sides with a dent between them.
pub fn crown() -> Model {
    prism(&[[-1.5, -1.0], [1.5, -1.0], [1.5, 1.5], [0.25, -0.5], [-1.5, 1.25]], [-0.5, 0.5])
}

/// A comb: a polygon with three dents.
pub fn comb() -> Model {
    let teeth = [
        [-1.75, -1.0],
        [1.75, -1.0],
        [1.75, 1.25],
        [1.25, 1.25],
        [1.0, -0.5],
        [0.5, 1.0],
        [0.0, 1.0],
        [-0.25, -0.5],
        [-0.75, 1.5],
        [-1.25, 1.5],
        [-1.5, -0.25],
    ];
    prism(&teeth, [-0.25, 0.75])
}

/// A square frame around a hole.
pub fn frame() -> Model {
    let square = |size: f32, z: f32| [[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z]];
    let vertices = [square(1.5, -0.5), square(1.5, 0.5), square(0.75, -0.5), square(0.75, 0.5)].concat();
    let faces = (0..4).flat_map(|side| {
        let next = (side + 1) % 4;
        let [out, out_above, within, within_above] = [0, 4, 8, 12].map(|ring| [ring + side, ring + next]);
        [
            vec![out[0], out[1], out_above[1], out_above[0]],
            vec![within[1], within[0], within_above[0], within_above[1]],
            vec![out_above[0], out_above[1], within_above[1], within_above[0]],
            vec![out[1], out[0], within[0], within[1]],
        ]
    });
    Model { vertices, faces: faces.collect() }
}

/// Two cubes that overlap.
pub fn pair() -> Model {
    cube().placed(1.5, [-1.5, -1.0, -0.5]).and(&cube().placed(1.25, [-0.5, -0.25, -0.25]))
}

/// A cube with a cavity.
pub fn shell() -> Model {
    cube().placed(2.0, [-1.0; 3]).and(&cube().placed(1.0, [-0.5; 3]).turned(|_| true))
}

/// A landscape of three times three squares, two triangles each: an open surface.
pub fn hills() -> Model {
    let heights =
        [0.0, 0.5, -0.25, 0.25, 0.75, -0.5, 1.0, 0.0, 0.25, -0.75, 0.5, 0.5, -0.25, 0.0, 0.75, 0.25];
    let at = |index: usize| [(index % 4) as f32 - 1.5, heights[index], (index / 4) as f32 - 1.5];
    let cells = (0..9).map(|cell| cell / 3 * 4 + cell % 3);
    let faces =
        cells.flat_map(|first| [vec![first, first + 4, first + 5], vec![first, first + 5, first + 1]]);
    Model { vertices: (0..16).map(at).collect(), faces: faces.collect() }
}

/// A tetrahedron.
pub fn tetrahedron() -> Model {
    let vertices = vec![[-1.0, -1.0, -1.0], [1.5, -1.0, 0.0], [-0.5, 1.5, 0.25], [-0.25, -0.5, 1.5]];
    Model { vertices, faces: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(Vec::from).to_vec() }
}

/// A strip of six triangles that winds upward, with corners in the order of a strip.
pub fn strip() -> Model {
    let vertices = vec![
        [-1.5, -1.0, 0.0],
        [-1.5, 0.0, 0.5],
        [-0.5, -1.0, 0.25],
        [-0.5, 0.25, 0.0],
        [0.5, -0.75, 0.5],
        [0.5, 0.75, -0.25],
        [1.5, -0.5, 0.0],
        [1.5, 1.25, 0.5],
    ];
    let faces =
        (0..6).map(|at| if at % 2 == 0 { vec![at, at + 1, at + 2] } else { vec![at + 1, at, at + 2] });
    Model { vertices, faces: faces.collect() }
}
