//! Tests of the session with the requests of a page.

use crate::Session;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;
use serde_json::Value;
use std::path::Path;
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_lang::{Registry, read};

const BALL: &str = "let size 2
    camera eye { pixeldim 60 45  worlddim 8 6  viewpoint 4 3 6  samples 4 }
    material red { ambient 2 0 0  diffuse 4 1 1 }
    sphere ball { material red  center 4 3 -2  radius \"size\" }
    light lamp { location 1 7 2  emissivity 9 9 9 }
";

fn asked(session: &mut Session, path: &str, body: &str) -> Value {
    let answer = session.answer(path, body.as_bytes());
    let text = String::from_utf8_lossy(&answer.bytes).into_owned();
    assert_eq!(answer.status, 200, "{path}: {text}");
    serde_json::from_str(&text).unwrap_or_else(|_| Value::from(text))
}

/// Renders the scene, `count` areas at a time, and returns the picture.
fn painted(session: &mut Session, count: usize) -> Vec<u8> {
    while !session.answer(&format!("paint/1/{count}"), b"").bytes.is_empty() {}
    session.answer("bytes/1", b"").bytes
}

#[test]
fn the_steps_end_in_the_bytes_of_render() {
    for (text, count) in
        [(BALL.to_owned(), 1), (BALL.replace("samples 4", ""), 7), (BALL.replace("60 45", "1 1"), 2)]
    {
        let mut session = Session::new();
        asked(&mut session, "scene/1", &text);
        assert_eq!(session.answer("bytes/1", b"").status, 409, "not complete");
        let registry = Registry::get().expect("plugins");
        let loaded = read(registry, "scene", Path::new(""), text.as_bytes(), None)
            .unwrap_or_else(|report| panic!("{report}"));
        let whole = Renderer::default().picture(&Plan::for_picture(&loaded.model));
        assert!(painted(&mut session, count) == whole);
    }
}

#[test]
fn every_named_surface_is_a_sound_scene_with_a_picture_that_is_not_blank() {
    let mut session = Session::new();
    let all = asked(&mut session, "surfaces", "");
    let all = all.as_array().expect("a list");
    assert!(all.len() >= 20, "{}", all.len());
    for surface in all {
        let name = surface["name"].as_str().expect("a name");
        let text = asked(&mut session, &format!("surface/{name}"), "");
        let text = text.as_str().expect("a text").replace("400 300", "32 24");
        let told = asked(&mut session, "scene/1", &text);
        assert_eq!(told["warnings"], "", "{name}");
        let bytes = painted(&mut session, 100);
        let first = &bytes[..3];
        assert!(
            bytes.chunks(3).filter(|pixel| *pixel != first).count() > 32 * 24 / 10,
            "{name} is hardly seen"
        );
        assert_eq!(asked(&mut session, "painted/1", "")["words"], Value::Null, "{name}");
    }
}

#[test]
fn a_file_that_the_scene_names_is_told_of_and_can_be_given() {
    let mut session = Session::new();
    let cloth = "texture cloth { filename \"of a page/cloth 1.png\" }
        texplane picture { material red  normal 0 0 1  point 1 1 -1  xdir 1 0 0  dimensions 4 4  texname cloth  mode 0 }\n";
    let text = BALL.to_owned() + cloth;
    let answer = session.answer("scene/1", text.as_bytes());
    assert_eq!(answer.status, 422);
    let told: Value = serde_json::from_slice(&answer.bytes).expect("JSON");
    assert_eq!(told["lacking"], serde_json::json!(["of a page/cloth 1.png"]));
    asked(&mut session, "scene/2", BALL);
    while !session.answer("paint/2/50", b"").bytes.is_empty() {}
    let image = session.answer("png/2", b"").bytes;
    assert_eq!(session.answer("file/cloth%201.png", &image).status, 200);
    let told = asked(&mut session, "scene/1", &text);
    assert_eq!(told["lacking"], serde_json::json!([]));
    assert!(painted(&mut session, 50).iter().any(|byte| *byte > 0));
    assert_eq!(told["warnings"], "");
}

#[test]
fn a_file_that_stands_for_two_of_its_name_is_told_of() {
    let mut session = Session::new();
    asked(&mut session, "scene/1", BALL);
    while !session.answer("paint/1/50", b"").bytes.is_empty() {}
    let image = session.answer("png/1", b"").bytes;
    assert_eq!(session.answer("file/marble.png", &image).status, 200);
    let textures = "texture old { filename \"old/marble.png\" }
        texture new { filename \"new/marble.png\" }
        texplane left { material red  normal 0 0 1  point 1 1 -1  xdir 1 0 0  dimensions 4 4  texname old  mode 0 }
        texplane right { material red  normal 0 0 1  point 1 1 -2  xdir 1 0 0  dimensions 4 4  texname new  mode 0 }\n";
    let told = asked(&mut session, "scene/2", &(BALL.to_owned() + textures));
    let warnings = told["warnings"].as_str().expect("warnings");
    assert!(
        warnings.contains("the file `marble.png` stands for `new/marble.png`, `old/marble.png`"),
        "{warnings}"
    );
}

#[test]
fn errors_have_places_in_the_text() {
    let mut session = Session::new();
    let text = BALL.replace("center", "centre\u{1f600}");
    let answer = session.answer("scene/1", text.as_bytes());
    assert_eq!(answer.status, 422);
    let told: Value = serde_json::from_slice(&answer.bytes).expect("JSON");
    assert_eq!(told["lines"][0], 4);
    let text = BALL.replace("radius", "raduis");
    let faults = asked(&mut session, "diagnose", &text);
    let fault = &faults[0];
    assert_eq!(fault["meant"], "radius");
    let [start, end] = [0, 1].map(|side| fault["place"][side].as_u64().expect("a place") as usize);
    assert_eq!(&text[start..end], "raduis");
    assert!(fault["message"].as_str().is_some_and(|message| message.contains("did you mean")), "{fault}");
}

#[test]
fn what_can_be_written_and_what_words_mean_is_told_as_by_the_language_server() {
    let mut session = Session::new();
    let at = BALL.find("radius").expect("there");
    let proposals = asked(&mut session, &format!("complete/{at}"), BALL);
    let labels: Vec<_> =
        proposals.as_array().expect("a list").iter().filter_map(|one| one["label"].as_str()).collect();
    assert!(labels.contains(&"scale"), "{labels:?}");
    let hover = asked(&mut session, &format!("hover/{}", at + 1), BALL);
    assert!(hover["text"].as_str().is_some_and(|text| text.starts_with("**radius** of sphere")), "{hover}");
    assert_eq!(hover["place"], serde_json::json!([at, at + 6]));
    let signature =
        asked(&mut session, &format!("signature/{}", BALL.find("4 3 -2").expect("there") + 2), BALL);
    assert_eq!((&signature["label"], &signature["active"]), (&"center x y z".into(), &1.into()));
}

#[test]
fn a_formula_takes_the_place_of_the_one_before_and_unknown_names_become_numbers() {
    let mut session = Session::new();
    let text = asked(&mut session, "surface/torus", "").as_str().expect("a text").to_owned();
    assert_eq!(asked(&mut session, "formula", &text), "(sqrt(x^2 + z^2) - R)^2 + y^2 - r0^2");
    let body = serde_json::json!({ "text": text, "formula": "x^2 + y^2 + k*z^2 = R" }).to_string();
    let changed = asked(&mut session, "formula/change", &body)["text"].as_str().expect("a text").to_owned();
    assert_eq!(asked(&mut session, "formula", &changed), "x^2 + y^2 + k*z^2 - (R)");
    assert!(changed.contains("\nlet k 1\n") && changed.matches("let R").count() == 1, "{changed}");
    asked(&mut session, "scene/1", &changed);
    let numbers = asked(&mut session, "entity/1/numbers", "");
    assert_eq!(numbers["attributes"][0]["name"], "k");
    let slid = r#"{"name":"","attribute":"k","values":["2.5"]}"#;
    let slid = asked(&mut session, "try/1", slid)["text"].as_str().expect("a text").to_owned();
    assert_eq!(slid, changed.replace("let k 1", "let k 2.5"));
    // A text without a formula is replaced.
    let body = serde_json::json!({ "text": "", "formula": "x + y" }).to_string();
    asked(&mut session, "formula/change", &body);
    asked(&mut session, "scene/2", &changed);
}

#[test]
fn the_name_of_a_surface_and_its_numbers_follow_the_formula() {
    let mut session = Session::new();
    let mut formula_of = |text: &str, formula: &str| {
        let body = serde_json::json!({ "text": text, "formula": formula }).to_string();
        asked(&mut session, "formula/change", &body)["text"].as_str().expect("a text").to_owned()
    };
    let text = crate::surfaces::scene("barth-6").expect("there");
    let other = formula_of(&text, "x^2 + y^2 + P*z^2 - 1");
    assert!(other.starts_with("# a surface by its formula\nlet P "), "{other}");
    assert!(!other.contains("let w"), "{other}");
    let cubic = formula_of(&other, "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1");
    assert!(
        cubic.starts_with("# Cayley's cubic: four nodes, the most that a cubic can have\n\nlook_at"),
        "{cubic}"
    );
    // What somebody wrote stays, and so does a number that something else needs.
    let own = text.replacen("# Barth's sextic", "# my sextic", 1)
        + "sphere dot { material front  radius \"w/10\" }\n";
    let changed = formula_of(&own, "x + y");
    assert!(changed.starts_with("# my sextic: 65 nodes") && changed.contains("\nlet w 1\n"), "{changed}");
}

#[test]
fn an_unknown_surface_is_said_to_be_unknown() {
    let mut session = Session::new();
    for (name, words) in [
        ("bart-6", "there is no surface `bart-6`: did you mean `barth-6`?"),
        ("teapot", "there is no surface `teapot`: choose one from the list beside the formula"),
    ] {
        let answer = session.answer(&format!("surface/{name}"), b"");
        assert_eq!((answer.status, &*String::from_utf8_lossy(&answer.bytes)), (404, words));
    }
}

#[test]
fn a_smooth_picture_has_one_sample_in_flat_places_and_16_at_edges() {
    let [width, height] = [97, 70];
    let mut smooth = vec![0; 3 * width * height];
    for part in 0..2 {
        let mut session = Session::new();
        asked(&mut session, &format!("smooth/1/{width}/{height}/{part}/2"), BALL);
        loop {
            let bytes = session.answer("paint/1/2", b"").bytes;
            if bytes.is_empty() {
                break;
            }
            let mut rest = &bytes[..];
            while !rest.is_empty() {
                let number = |index: usize| {
                    u32::from_le_bytes([0, 1, 2, 3].map(|byte| rest[4 * index + byte])) as usize
                };
                let [left, top, wide, high, _, is_final, blocks] = [0, 1, 2, 3, 4, 5, 6].map(number);
                assert_eq!((blocks, is_final), (wide * high, 1));
                for pixel in 0..blocks {
                    let (from, to) = (
                        28 + 12 * blocks + 3 * pixel,
                        3 * ((top + pixel / wide) * width + left + pixel % wide),
                    );
                    smooth[to..to + 3].copy_from_slice(&rest[from..from + 3]);
                }
                rest = &rest[28 + 12 * blocks + (3 * blocks).next_multiple_of(4)..];
            }
        }
    }
    let registry = Registry::get().expect("plugins");
    let image = |samples| {
        let mut loaded = read(registry, "scene", Path::new(""), BALL.as_bytes(), None)
            .unwrap_or_else(|report| panic!("{report}"));
        loaded.model.camera.value.pixels = [width, height];
        loaded.model.camera.value.samples = samples;
        Renderer::default().picture(&Plan::for_picture(&loaded.model))
    };
    let (single, many) = (image(1), image(16));
    let pixel = |x: usize, y: usize| 3 * (y * width + x)..3 * (y * width + x) + 3;
    let differ =
        |one: &[u8], other: &[u8]| one.iter().zip(other).any(|(one, other)| one.abs_diff(*other) > 8);
    let mut edges = 0;
    for y in 0..height {
        for x in 0..width {
            let mine = &single[pixel(x, y)];
            let beside = [
                (x.max(1) - 1, y),
                ((x + 1).min(width - 1), y),
                (x, y.max(1) - 1),
                (x, (y + 1).min(height - 1)),
            ];
            let is_edge = beside.iter().any(|(x, y)| differ(mine, &single[pixel(*x, *y)]));
            edges += usize::from(is_edge);
            assert_eq!(&smooth[pixel(x, y)], if is_edge { &many[pixel(x, y)] } else { mine }, "{x} {y}");
        }
    }
    assert!((50..2000).contains(&edges), "{edges}");
}

#[test]
fn the_camera_is_moved_in_the_text() {
    let mut session = Session::new();
    let text = asked(&mut session, "surface/torus", "").as_str().expect("a text").to_owned();
    asked(&mut session, "scene/1", &text);
    let camera = asked(&mut session, "camera/1", "");
    let by = |orbit: [f64; 2]| serde_json::json!({ "stand": camera["stand"], "around": [0, 0, 0], "orbit": orbit, "pan": [0, 0], "dolly": 1 });
    let still = asked(&mut session, "move/1", &by([0.0, 0.0]).to_string());
    assert_eq!(still["text"], text.as_str());
    let moved = asked(&mut session, "move/1", &by([30.0, 0.0]).to_string());
    let moved = moved["text"].as_str().expect("a text");
    let differ = text.lines().zip(moved.lines()).filter(|(one, other)| one != other).count();
    assert_eq!((differ, moved.lines().count()), (1, text.lines().count()));
}

#[test]
fn files_and_proofs_are_of_the_picture() {
    let mut session = Session::new();
    asked(&mut session, "scene/1", BALL);
    assert_eq!(session.answer("png/1", b"").status, 409);
    let bytes = painted(&mut session, 50);
    let png = session.answer("png/1", b"").bytes;
    let mut reader = image_of(&png);
    assert_eq!(reader.split_off(0), bytes);
    assert!(session.answer("exr/1", b"").bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let stl = session.answer("stl/1/ball", b"").bytes;
    let count = u32::from_le_bytes([stl[80], stl[81], stl[82], stl[83]]) as usize;
    assert_eq!(stl.len(), 84 + 50 * count);
    assert_eq!(session.answer("stl/1/nobody", b"").status, 409);
    let mut verdicts = Vec::new();
    loop {
        let more = session.answer("prove/1/500", b"").bytes;
        if more.is_empty() {
            break;
        }
        verdicts.extend(more);
    }
    assert_eq!(verdicts.len(), 60 * 45);
    assert!(verdicts.iter().all(|verdict| *verdict == 1));
}

#[test]
fn where_two_objects_coincide_pixels_are_undecided() {
    let mut session = Session::new();
    let twin = "sphere twin { material red  center 4 3 -2  radius 2 }\n";
    asked(&mut session, "scene/1", &(BALL.to_owned() + twin));
    let verdicts = session.answer("prove/1/5000", b"").bytes;
    let count = |wanted: u8| verdicts.iter().filter(|verdict| **verdict == wanted).count();
    assert!(count(1) > 300 && count(2) > 300, "{} proven, {} ties", count(1), count(2));
    assert_eq!(count(1) + count(2), 60 * 45);
}

fn image_of(png: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut bytes).expect("a picture");
    bytes.truncate(info.buffer_size());
    bytes
}

#[test]
fn pixels_are_explained_and_layers_and_the_plan_are_there() {
    let mut session = Session::new();
    asked(&mut session, "scene/1", BALL);
    let told = asked(&mut session, "probe/1/30/22", "");
    assert!(told["text"].as_str().is_some_and(|text| text.contains("ball")));
    assert_eq!(told["lines"], serde_json::json!([4, 4]));
    assert_eq!(session.answer("layer/1/depth", b"").bytes.len(), 3 * 60 * 45);
    assert!(asked(&mut session, "plan/1", "").as_str().is_some_and(|plan| plan.contains("mirrors")));
    assert_eq!(asked(&mut session, "object/1/30/22", "")["name"], "ball");
    assert_eq!(session.answer("probe/1/60/22", b"").status, 404);
    assert_eq!(session.answer("probe/0/30/22", b"").status, 410);
    assert_eq!(session.answer("no/1", b"").status, 404);
    assert_eq!(session.answer("", b"").status, 404);
}

#[test]
fn half_written_scenes_and_any_request_end_in_no_panic() {
    let (mut session, mut random) = (Session::new(), Pcg64Mcg::new(7));
    let mut below = |most: usize| random.next_u32() as usize % most;
    let pieces = [
        "{",
        "}",
        "\"",
        " 1e300 ",
        "-",
        "sphere",
        "let k 0\n",
        "\u{1f600}",
        "formula",
        "^",
        "(",
        "\n",
        "#",
        "repeat i 3 {",
    ];
    for _ in 0..300 {
        let mut text = BALL.replace("60 45", "8 6");
        for _ in 0..1 + below(3) {
            let mut at = below(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            match below(2) {
                0 => text.insert_str(at, pieces[below(pieces.len())]),
                _ => text.truncate(at),
            }
            if text.is_empty() {
                break;
            }
        }
        let at = below(text.len() + 2);
        if session.answer("scene/1", text.as_bytes()).status == 200 {
            painted(&mut session, 9);
            session.answer("prove/1/48", b"");
        }
        for path in [
            format!("complete/{at}"),
            format!("hover/{at}"),
            format!("signature/{at}"),
            "diagnose".into(),
            "format".into(),
            "formula".into(),
        ] {
            session.answer(&path, text.as_bytes());
        }
    }
}
