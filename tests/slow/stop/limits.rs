//! The options `--time-limit` and `--max-memory`, and what a render that stops writes to standard output.

use crate::common::program::{folder, names_in, scene};
use crate::stop::{bytes, render, workplace};

#[test]
fn too_little_memory_is_refused_and_reached_memory_stops() {
    let folder = folder();
    let path = scene("material/touching-mirrors.ray");
    let args = [path.to_str().expect("UTF-8"), "-o", "a.png"];
    let (status, _, err) = render(&folder, &[&args[..], &["--max-memory", "5KiB"]].concat());
    let said = "error: 5.0 KiB of memory is not enough for this image\n |\n = help: it needs at least about ";
    assert!(status == 2 && err.starts_with(said) && err.ends_with(" MiB\n"), "{err}");
    assert!(names_in(folder.path()).is_empty());

    // The rays that are reflected here need far more than 16 MiB.
    let least: f64 = err[said.len()..].split(' ').next().expect("a number").parse().expect("a number");
    let limit = format!("{}MiB", least.ceil() + 16.0);
    let (status, _, err) = render(&folder, &[&args[..], &["--max-memory", &limit]].concat());
    assert_eq!(status, 130, "{err}");
    let said = format!("the memory limit of {}.0 MiB has been reached\n", limit.trim_end_matches("MiB"));
    assert!(err.starts_with(&said), "{err}");
    assert_eq!(render(&folder, &[&args[..], &["--resume"]].concat()).0, 0);
    assert_eq!(render(&folder, &[&args[..1], &["-o", "whole.png"]].concat()).0, 0);
    assert!(bytes(&folder, "a.png") == bytes(&folder, "whole.png"));
}

#[test]
fn limits_that_make_no_sense_are_refused() {
    let folder = workplace();
    for (option, values, says) in [
        ("--time-limit", ["90", "0s", "soon"], "give a time above 0 and its unit, as `90s`, `5m` or `1.5h`"),
        ("--max-memory", ["much", "-5", "5 apples"], "give a size as `200MiB` or `1.5GiB`"),
    ] {
        for value in values {
            let (status, _, err) = render(&folder, &["hall.ray", &format!("{option}={value}")]);
            let first = format!("error: invalid value '{value}' for '{option} <");
            assert!(status == 2 && err.starts_with(&first) && err.contains(says), "{err}");
        }
    }
}

#[test]
fn standard_output_is_filled_with_black_and_cannot_be_resumed() {
    let folder = workplace();
    let args = ["hall.ray", "--samples", "16", "-o", "-"];
    let (status, out, err) = render(&folder, &[&args[..], &["--time-limit", "100ms"]].concat());
    assert_eq!(status, 130);
    let (reason, rest) = err.split_once('\n').expect("two lines");
    assert_eq!(reason, "the time limit of 100ms has been reached");
    assert!(
        rest.ends_with(" % of the image is rendered, and the rest is black; only files can be resumed\n"),
        "{rest}"
    );
    let picture = image::load_from_memory(&out).expect("a whole picture").into_rgb8();
    assert_eq!((picture.dimensions(), picture.get_pixel(639, 479).0), ((640, 480), [0; 3]));
    let (status, out, err) = render(&folder, &[&args[..], &["--resume"]].concat());
    assert_eq!((status, out.len()), (2, 0));
    let said = "error: cannot keep a checkpoint beside `-`\n |\n = help: name a file for the image with `-o FILE`, \
                or leave out `--resume`\n";
    assert_eq!(err, said);
}
