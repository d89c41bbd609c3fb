use super::*;
use std::time::{Duration, Instant};

fn cleaned(text: &str) -> String {
    let mut cleaned = Cleaned { bytes: text.as_bytes().to_vec(), found: BTreeMap::new() };
    cleaned.all();
    assert_eq!(cleaned.bytes.len(), text.len());
    cleaned.text()
}

#[test]
fn only_what_is_no_part_of_a_name_is_left_out() {
    for (text, clean) in [
        ("center <4, 3,-4> radius (1)", "center  4  3 -4  radius  1 "),
        ("ambient(1,1,1);", "ambient 1 1 1  "),
        ("radius=2 material=red;", "radius 2 material red "),
        ("material “a b” { }", "material   \"a b\"   { }"),
        ("ambient #ff0000 }", "ambient 1 1 1   }"),
        ("ambient #f00 }", "ambient 1 1 1}"),
        ("a { b 1 } // ball, (1)\nc", "a { b 1 }             \nc"),
        ("{/* one\ntwo */ a 1 }", "{      \n       a 1 }"),
    ] {
        assert_eq!(cleaned(text), clean, "{text}");
    }
    for text in [
        "material a<b> { ambient 1 1 1 }",
        "center 0,5 1 2",
        "sphere (left) { material wall,red radius 1 } # (1, 2); #ff0000",
        "profile \"2 + sin(y)\" text \"“a” = (1, 2);\"",
        "radius 2 #fff comment",
        "sphere /* { radius 2 }\nsphere //a\n{ radius 2 }",
        "texture \"//host/a.png\" name a//b # see // and /* */",
    ] {
        assert_eq!(cleaned(text), text);
    }
}

#[test]
fn long_texts_of_one_sign_take_no_time() {
    let start = Instant::now();
    for sign in ["„ ", "“", "<1 ", "(", ", ", "1, ", "=", "; ", "#fff ", "a=\"", "‘a", "/*", "// ", "\""]
    {
        cleaned(&sign.repeat(200_000));
    }
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}
