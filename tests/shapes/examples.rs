//! What the examples of the crates answer.

#[path = "../../src/exact/examples/bounds.rs"]
mod bounds;
#[path = "../../src/lang/examples/mesh.rs"]
mod mesh;
#[path = "../../src/lang/examples/rays.rs"]
mod rays;
#[path = "../../src/lang/examples/scene.rs"]
mod scene;
#[path = "../../src/core/examples/torus.rs"]
mod torus;

#[test]
fn a_formula_is_enclosed_and_its_root_is_proven() {
    let expected = "\
y from 0 to 8: from -1.500 to 2.500, so it may be 0
y from 0 to 4: from -0.257 to 2.500, so it may be 0
y from 0 to 2: from 1.000 to 2.500, so it is not 0
y from 0 to 1: from 1.250 to 2.341, so it is not 0
the first root is 3.741554864095, which is proven
";
    assert_eq!(bounds::answer().expect("an answer"), expected);
}

#[test]
fn a_shape_is_one_formula() {
    let expected = "\
from x = 5, it is 2.163339973 away: sqrt(0.7) before the circle of radius 2

             %%%%%%%%%%%%%%%%####*+=
         @@@%%%############%%%%%%%%##*+-
      @@@@%%#**+++=====+++**##%%%@@@%%#*+=:
    @@@@%%#*+=--:......::--=+*#%%@@@@@%%#*+-.
   @@@@%%#*+=:.......       .:=*#%@@@@@%%#*=-.
  %@@@@%%#*+-...                 #@@@@@%%#*=-..
  %@@@@@%%#*=-.                   @@@@%%#*+=-..
  #@@@@@@%%##*+-                 @@@%%##*+=-...
   #%@@@@@@%%%###**+=       #%%%%%%%##*+=-:...
    *#%%%%%%%%%%%%%%%%%%%%%%%%####**++=-:....
      +**###%%%%%%%%########****++==-:.....
         -=++***********++++===--:......
             .::---------:::........

";
    assert_eq!(torus::answer().expect("an answer"), expected);
}

#[test]
fn a_scene_is_read_asked_and_rendered() {
    let expected = "\
`ball` is hit at a distance of 9.262334







                        +***++=:
                     *###****++=-:.
                   *********++==-::.
                  +********++==--:..
                  =+++++++===--::..
                  -=+=====---::... ...
..................:==++-::::...  :... .......
.:::::::::::::::::::--------:::::::.          ..........
---------------------:::::::::::..                ::::::
++++++++++++++++++++++    ....                  -------:
****#################*****              ++++==========--
%%%%%%%%%%%%%%%%%%%%%%%%%%%#########********+++++++++===
@@@@@@@@@@@@@@@@@@@@@@@@@@@@@%%%%%%%%########********+++
";
    assert_eq!(scene::answer().expect("an answer"), expected);
}

#[test]
fn a_mesh_in_memory_is_asked_about_a_million_rays() {
    let expected = "\
555540 of 1000000 rays hit the mesh
Hit: t from 0.8391438710556582 to 0.8391438710556584
";
    assert_eq!(mesh::answer().expect("an answer"), expected);
}
