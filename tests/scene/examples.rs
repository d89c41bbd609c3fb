//! What the examples of the crates answer.

#[path = "../../src/exact/examples/bounds.rs"]
mod bounds;
#[path = "../../src/lang/examples/scene.rs"]
mod scene;
#[path = "../../src/core/examples/torus.rs"]
mod torus;

#[test]
fn a_formula_is_enclosed_and_its_root_is_proven() {
    let expected = "";
    assert_eq!(bounds::answer().expect("an answer"), expected);
}

#[test]
fn a_shape_is_one_formula() {
    let expected = "";
    assert_eq!(torus::answer().expect("an answer"), expected);
}

#[test]
fn a_scene_is_read_asked_and_rendered() {
    let expected = "";
    assert_eq!(scene::answer().expect("an answer"), expected);
}
