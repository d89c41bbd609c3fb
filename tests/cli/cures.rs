//! What beginners write, and the one message that cures it.

use crate::common::program::{folder, outcome, tabray};
use std::fs;

/// Asserts that a scene of these entities, beside a camera and a material, has one error, with this cure.
fn cured(entities: &str, cure: &str) {
    let folder = folder();
    let scene = format!(
        "camera eye {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 6 }}\nmaterial blue {{ ambient 0 0 1 }}\n{entities}\n"
    );
    fs::write(folder.path().join("a.ray"), scene).expect("a scene");
    let (status, _, said) = outcome(tabray(&folder).args(["check", "a.ray", "--color", "never"]));
    assert!(status == 2 && said.matches("error:").count() == 1, "{entities}: {said}");
    assert!(said.contains(&format!("help: {cure}\n")), "{entities}: {said}");
}

#[test]
fn a_name_of_several_words_is_joined_where_it_is_given_and_where_it_is_used() {
    let ball = "{ material blue center 4 2 -4 radius 2 }";
    for (name, joined) in [
        ("big ball", "big_ball"),
        ("my big red ball", "my_big_red_ball"),
        ("big sphere", "big_sphere"),
        ("key light", "key_light"),
        ("\"my big\" ball", "my_big_ball"),
        ("ball 2", "ball_2"),
    ] {
        cured(&format!("sphere {name} {ball}"), &format!("a name is one word: `sphere {joined} {{`"));
    }
    for (before, name, cure) in [
        ("", "my blue", "material blue"),
        ("", "dark red", "material dark_red"),
        ("", "very dark red", "material very_dark_red"),
        ("material \"dark red\" { ambient 1 0 0 }", "dark red", "material \"dark red\""),
        ("material dark_red { ambient 1 0 0 }", "dark red", "material dark_red"),
    ] {
        let cure = format!("a name is one word, or stands in quotes: `{cure}`");
        cured(&format!("{before} sphere s {{ material {name} center 4 2 -4 radius 2 }}"), &cure);
        cured(&format!("{before} sphere s {{ center 4 2 -4 radius 2 material {name} }}"), &cure);
    }
    let takes = "a sphere takes `material`, `center`, `radius`, `scale`, `shader`";
    cured("sphere s { material blue shiny center 4 2 -4 radius 2 }", takes);
}

#[test]
fn the_file_of_an_image_or_of_a_mesh_goes_where_it_belongs() {
    let texture =
        "the file of an image belongs to a texture: define `texture wood { filename wood.png }`, and write";
    let shader = "a shader draws an image: define a texture with this file, `texture wood { filename wood.png }`, and \
                  a shader, `image NAME { texture wood }`, and give the object `shader NAME`";
    let sphere = |more: &str| format!("sphere s {{ center 4 2 -4 radius 2 {more} }}");
    cured("image i { texture wood.png }", &format!("{texture} `wood` here"));
    cured("image i { wood.png }", &format!("{texture} `texture wood`"));
    cured("image i { filename wood.png }", &format!("{texture} `texture wood`"));
    cured("environment e { texture wood.png }", &format!("{texture} `wood` here"));
    cured("texture w { wood.png }", "write `filename wood.png`");
    cured("texture w { file wood.png }", "a texture takes `filename`, `cutout`, `coverage`");
    cured("mesh m { \"my ball.obj\" material blue }", "write `file \"my ball.obj\"`");
    for text in ["texture w wood.png", "texture w \"wood.png\"", "texture w wood.png { }"] {
        cured(text, "attributes go in braces: `texture w { filename wood.png }`");
    }
    cured(&sphere("material wood.png"), shader);
    cured(&sphere("material blue wood.png"), shader);
    cured(&sphere("material blue shader wood.png"), shader);
    cured(&sphere("material blue.mtl"), "here stands the name of the material, not that of a file");
    cured(
        &sphere("material red.mtl"),
        "such a file belongs to that of a `mesh`; define the material in the scene, `material red { ... }`, and write \
         `red` here",
    );
}

#[test]
fn a_loop_of_another_language_is_told_as_the_repeat_that_it_means() {
    for (head, cure) in [
        ("for i 5", "write `repeat i 5 {`; in its braces, `\"i\"` goes from 0 to 4"),
        ("for(int i=0;i<=8;i++)", "write `repeat i 9 {`; in its braces, `\"i\"` goes from 0 to 8"),
        ("for i in range(2, 6):", "write `repeat i 4 {`; in its braces, `\"i + 2\"` goes from 2 to 5"),
        ("for i = 1 to 10", "write `repeat i 10 {`; in its braces, `\"i + 1\"` goes from 1 to 10"),
        ("while i < 3", "write `repeat i 3 {`; in its braces, `\"i\"` goes from 0 to 2"),
        ("loop 5 times", "write `repeat i 5 {`; in its braces, `\"i\"` goes from 0 to 4"),
        ("for x 1 10", "write `repeat i 9 {`; in its braces, `\"i + 1\"` goes from 1 to 9"),
        ("repeat i in 5", "write `repeat i 5 {`; in its braces, `\"i\"` goes from 0 to 4"),
        ("repeat 5 times", "write `repeat i 5 {`; in its braces, `\"i\"` goes from 0 to 4"),
        ("for i in range(0, 10, 2)", "write `repeat NAME COUNT { ENTITIES }`"),
        ("for i in things", "write `repeat NAME COUNT { ENTITIES }`"),
    ] {
        cured(&format!("{head} {{ sphere s {{ material blue center \"i\" 2 -4 radius 1 }} }}"), cure);
    }
    for (value, cure) in [("2*i", "\"2*i\""), ("i", "\"i\""), ("i/2+1", "\"i/2+1\"")] {
        let text = format!("repeat i 3 {{ sphere s {{ material blue center {value} 2 -4 radius 1 }} }}");
        cured(&text, &format!("a formula goes in quotes: `{cure}`"));
    }
}

#[test]
fn numbers_and_colours_in_words_or_as_products_are_told_in_digits() {
    for (attribute, cure) in [
        ("radius two", "write `radius 2`"),
        ("radius minus two", "write `radius -2`"),
        // A number in several words is not guessed.
        ("radius one hundred", "`radius`: the distance from the centre to the surface"),
        ("radius sqrt(2)", "a formula goes in quotes: `\"sqrt(2)\"`"),
        ("radius 2*3", "a formula goes in quotes: `\"2*3\"`"),
    ] {
        cured(&format!("sphere s {{ material blue center 4 2 -4 {attribute} }}"), cure);
    }
    for (attribute, cure) in [
        ("ambient 1 six zero", "write `ambient 1 6 0`"),
        ("ambient 50 %", "a grey is three equal numbers: `ambient 0.5 0.5 0.5`"),
        ("ambient 0.7f", "a grey is three equal numbers: `ambient 0.7 0.7 0.7`"),
        (
            "ambient 7/10",
            "a formula goes in quotes, and a grey is three equal numbers: `ambient \"7/10\" \"7/10\" \"7/10\"`",
        ),
        ("ambient dark blue", "a colour is its red, green and blue: `ambient 0 0 0.5`"),
        ("ambient \"light grey\"", "a colour is its red, green and blue: `0.75 0.75 0.75`"),
        ("ambient hsl(120,50%,50%)", "`ambient`: the emission in red, green and blue, independent of lights"),
    ] {
        cured(&format!("material m {{ {attribute} }}"), cure);
    }
    let cameras = "fisheye f { pixeldim 160*120 position 0 0 0 target 0 0 -1 }";
    let folder = folder();
    fs::write(folder.path().join("a.ray"), cameras).expect("a scene");
    let (_, _, said) = outcome(tabray(&folder).args(["check", "a.ray"]));
    assert!(said.contains("help: write `pixeldim 160 120`"), "{said}");
}

#[test]
fn an_attribute_of_another_type_of_the_kind_names_the_types_that_have_it() {
    let have = "have it; a light takes `location`, `emissivity`, `size`, `falloff`, `at`";
    let light = "light l { location 0 0 0 emissivity 1 1 1 radius 1 }";
    cured(light, &format!("`area_light` and `sphere_light` {have}"));
    cured(
        "sphere s { material blue center 0 0 0 radius 1 color 1 0 0 }",
        "`glass` (as `colour`), `material` (as `diffuse`), `metal` (as `colour`) and `plastic` (as `colour`) have it: \
         write it there; a sphere takes `material`, `center`, `radius`, `scale`, `shader`",
    );
}
