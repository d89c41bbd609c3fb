//! `tabray fmt`, as people and scripts use it.

use crate::common::program::{folder, outcome, tabray};
use std::fs;

const UNTIDY: &str = "camera eye {\npixeldim 8 6 # wide\nworlddim 8 6   viewpoint 4 3 6\n}\n";
const TIDY: &str = "camera eye\n{\n    pixeldim  8 6 # wide\n    worlddim  8 6\n    viewpoint 4 3 6\n}\n";

#[test]
fn fmt_formats_in_place_checks_and_reads_standard_input() {
    let folder = folder();
    let path = folder.path().join("a.ray");
    fs::write(&path, UNTIDY).expect("room");
    let (status, _, err) = outcome(tabray(&folder).args(["fmt", "--check", "a.ray"]));
    assert_eq!((status, err.as_str()), (2, "error: a.ray: not formatted\n"));
    assert_eq!(fs::read_to_string(&path).expect("a file"), UNTIDY);
    let (status, out, err) = outcome(tabray(&folder).args(["fmt", "a.ray"]));
    assert_eq!((status, out.len(), err.as_str()), (0, 0, "formatted a.ray\n"));
    assert_eq!(fs::read_to_string(&path).expect("a file"), TIDY);
    for arguments in [["fmt", "a.ray"].as_slice(), &["fmt", "--check", "a.ray"]] {
        let (status, out, err) = outcome(tabray(&folder).args(arguments));
        assert_eq!((status, out.len(), err.as_str()), (0, 0, ""));
    }
    fs::write(&path, UNTIDY).expect("room");
    let (status, _, err) = outcome(tabray(&folder).args(["fmt", "missing", ".", "a.ray"]));
    assert_eq!(status, 1, "{err}");
    assert!(err.contains("cannot read `missing`") && err.ends_with("formatted a.ray\n"), "{err}");
    let (status, out, _) = outcome(tabray(&folder).args(["fmt", "-"]).write_stdin(UNTIDY));
    assert_eq!((status, String::from_utf8(out).as_deref()), (0, Ok(TIDY)));
}

#[test]
fn fmt_leaves_a_scene_whose_form_has_errors() {
    let folder = folder();
    let path = folder.path().join("a.ray");
    let text = "camera eye {\n  pixeldim 8 6\n";
    fs::write(&path, text).expect("room");
    let (status, _, err) = outcome(tabray(&folder).args(["fmt", "a.ray", "none.ray"]));
    assert_eq!(status, 2);
    assert!(err.contains("a.ray:2:16") && err.contains("missing `}` for camera `eye`"), "{err}");
    assert!(err.contains("cannot read `none.ray`"), "{err}");
    assert_eq!(fs::read_to_string(&path).expect("a file"), text);
    let mut input = tabray(&folder);
    let (status, out, _) = outcome(input.args(["fmt", "-"]).write_stdin(b"\xff".as_slice()));
    assert_eq!((status, out.len()), (2, 0));
}
