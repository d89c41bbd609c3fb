//! The scripts of `tabray farm slurm` under a real Slurm of two nodes on this machine.
//!
//! `cargo test --release --test slow -- --ignored --nocapture --test-threads 1 slurm`
#![cfg(target_os = "linux")]

mod cluster;

use crate::common::program::{folder, outcome, scene, tabray};
use assert_cmd::cargo::cargo_bin;
use cluster::{Cluster, wait};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tempfile::TempDir;

/// The options of the image: each of 16 parts takes some seconds of one core.
const OPTIONS: &str = "--size 640 --samples 512";
const PARTS: usize = 16;

/// A folder with the scripts of a scene, and the line that submits them.
struct Farm {
    folder: TempDir,
    line: String,
}

impl Farm {
    fn new() -> Self {
        Self::of(OPTIONS)
    }

    /// Makes the scripts of `big.png` with these options.
    fn of(options: &str) -> Self {
        let folder = folder();
        fs::copy(scene("gallery/hall-of-mirrors.ray"), folder.path().join("hall.ray")).expect("a copy");
        let parts = PARTS.to_string();
        let mut command = tabray(&folder);
        command.args(["farm", "slurm", "hall.ray", "-o", "big.png", "--parts", &parts, "--"]);
        let (status, line, err) = outcome(command.args(options.split(' ')));
        assert_eq!(status, 0, "{err}");
        Self { folder, line: String::from_utf8(line).expect("text").trim().to_owned() }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Submits the jobs; returns the numbers of the array and of the job that merges.
    fn submit(&self, cluster: &Cluster) -> (String, String) {
        let merge = number(&cluster.tell(self.path(), &self.line));
        let array: usize = merge.parse().expect("a number");
        ((array - 1).to_string(), merge)
    }

    fn log(&self, part: usize) -> String {
        fs::read_to_string(self.path().join(format!("big.png.slurm/part-{part}.log"))).unwrap_or_default()
    }

    fn part(&self, part: usize) -> PathBuf {
        self.path().join(format!("big.png.part-{part}-of-{PARTS}"))
    }

    /// Renders the image on this machine alone.
    fn alone(&self) -> Vec<u8> {
        let mut command = tabray(&self.folder);
        command.args(["render", "hall.ray", "-o", "alone.png"]);
        let (status, _, err) = outcome(command.args(OPTIONS.split(' ')));
        assert_eq!(status, 0, "{err}");
        fs::read(self.path().join("alone.png")).expect("an image")
    }

    fn merged(&self) -> Vec<u8> {
        fs::read(self.path().join("big.png")).expect("a merged image")
    }
}

/// Returns the number of the job at the end of what `sbatch` prints.
fn number(text: &str) -> String {
    text.split_whitespace().last().expect("a number").to_owned()
}

#[test]
#[ignore = "starts a cluster, as root, and takes a minute"]
fn parts_of_a_node_that_dies_are_rendered_by_another() {
    let Some(mut cluster) = Cluster::start("true") else { return };
    let farm = Farm::new();
    let (array, merge) = farm.submit(&cluster);
    wait("the first parts", || (1..=PARTS).any(|part| farm.log(part).contains("wrote")));
    let killed = cluster.kill(1, &array);
    assert!(killed > 0, "{}", cluster.states(&array));
    cluster.until(&merge, &["COMPLETED"]);
    assert_eq!(farm.merged(), farm.alone());
    let again = (1..=PARTS).filter(|part| farm.log(*part).contains("start 1")).count();
    assert!(again >= killed, "{killed} tasks were killed, and {again} were queued again");
    for part in (1..=PARTS).filter(|part| farm.log(*part).contains("start 1")) {
        println!("part-{part}.log:\n{}", farm.log(part));
    }
    println!("{}", cluster.tell(farm.path(), "sinfo"));
}

/// 24 frames, of which a node was killed while it rendered some.
#[test]
#[ignore = "starts a cluster, as root, and takes a minute"]
fn a_film_comes_out_though_a_node_dies() {
    const FRAMES: &str = "--size 320 --samples 64 --frames 1..24 --sweep pearl1.radius=.3..0.6";
    let Some(mut cluster) = Cluster::start("true") else { return };
    let farm = Farm::of(FRAMES);
    let (array, merge) = farm.submit(&cluster);
    wait("the first frames", || (1..=PARTS).any(|part| farm.log(part).contains("wrote")));
    let killed = cluster.kill(1, &array);
    assert!(killed > 0, "{}", cluster.states(&array));
    cluster.until(&merge, &["COMPLETED"]);
    let mut alone = tabray(&farm.folder);
    alone.args(["render", "hall.ray", "-o", "alone.png"]);
    assert_eq!(outcome(alone.args(FRAMES.split(' '))).0, 0);
    let read = |name: String| fs::read(farm.path().join(name)).expect("a frame");
    for frame in 1..=24 {
        assert!(
            read(format!("big-{frame:04}.png")) == read(format!("alone-{frame:04}.png")),
            "frame {frame}"
        );
    }
    let mut film = tabray(&farm.folder);
    assert_eq!(outcome(film.args(["film", "alone.png", "--animation", "alone.apng"])).0, 0);
    assert!(read("big.apng".to_owned()) == read("alone.apng".to_owned()));
    println!("{} tasks were killed\n{}\n{}", killed, cluster.states(&array), cluster.states(&merge));
    println!("merge.log:\n{}", read("big.png.slurm/merge.log".to_owned()).escape_ascii());
}

#[test]
#[ignore = "starts a cluster, as root, and takes a minute"]
fn after_a_part_that_fails_nothing_is_merged_until_it_is_rendered() {
    let Some(cluster) = Cluster::start("true") else { return };
    let farm = Farm::new();
    let in_its_way = farm.part(5);
    fs::create_dir(&in_its_way).expect("a folder");
    let (array, merge) = farm.submit(&cluster);
    cluster.until(&array, &["COMPLETED", "FAILED"]);
    assert_eq!(cluster.states(&array).lines().filter(|line| line.starts_with("FAILED")).count(), 1);
    println!("part-5.log:\n{}", farm.log(5));
    wait("the end of the job that merges", || cluster.states(&merge).starts_with("CANCELLED"));
    fs::remove_dir(&in_its_way).expect("a folder");
    let (status, _, err) = outcome(tabray(&farm.folder).args(["merge", "big.png"]));
    assert_eq!(status, 2, "{err}");
    assert!(err.contains("part 5 is missing"), "{err}");
    let again = number(&cluster.tell(farm.path(), "sbatch --array=5 big.png.slurm/render.sbatch"));
    let merge = format!("sbatch --dependency=afterok:{again} big.png.slurm/merge.sbatch");
    let merge = number(&cluster.tell(farm.path(), &merge));
    cluster.until(&merge, &["COMPLETED"]);
    assert_eq!(farm.merged(), farm.alone());
}

#[test]
#[ignore = "starts a cluster, as root, and takes a minute"]
fn parts_that_a_full_disk_refused_are_rendered_by_another_node() {
    let farm = Farm::new();
    // On the second node, the folder of the image is a disk that has no room for a part; the logs are where they were.
    let disk = format!(
        "mkdir {kept} && mount --bind {shared} {kept} && mount -t tmpfs -o size=8k tmpfs {shared} && \
         cp {kept}/hall.ray {shared} && mkdir {shared}/big.png.slurm && \
         mount --bind {kept}/big.png.slurm {shared}/big.png.slurm",
        shared = farm.path().display(),
        kept = farm.path().with_extension("kept").display(),
    );
    let Some(cluster) = Cluster::start(&disk) else { return };
    let (array, _) = farm.submit(&cluster);
    cluster.until(&array, &["COMPLETED", "FAILED"]);
    let refused: Vec<_> = (1..=PARTS).filter(|part| !farm.part(*part).exists()).collect();
    assert!(!refused.is_empty() && refused.len() < PARTS, "{refused:?}");
    println!("part-{}.log:\n{}", refused[0], farm.log(refused[0]));
    assert!(refused.iter().all(|part| farm.log(*part).contains("no space left")), "{}", farm.log(refused[0]));
    let refused = refused.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
    let again = format!("sbatch --array={refused} --nodelist=one big.png.slurm/render.sbatch");
    let again = number(&cluster.tell(farm.path(), &again));
    let merge = format!("sbatch --dependency=afterok:{again} --nodelist=one big.png.slurm/merge.sbatch");
    let merge = number(&cluster.tell(farm.path(), &merge));
    cluster.until(&merge, &["COMPLETED"]);
    assert_eq!(farm.merged(), farm.alone());
    fs::remove_dir(farm.path().with_extension("kept")).expect("an empty folder");
}

#[test]
#[ignore = "starts a cluster, as root, and takes a minute"]
fn nodes_with_different_instructions_make_one_image() {
    let farm = Farm::new();
    let program = cargo_bin!("tabray").display();
    let copy = farm.path().join("tabray");
    fs::copy(cargo_bin!("tabray"), &copy).expect("a copy");
    // On the second node, the program knows no more than the oldest instructions.
    let script = format!(
        "#!/bin/sh\ncommand=$1\nshift\n[ $command = render ] && set -- --cpu baseline \"$@\"\n\
         exec {} $command \"$@\"\n",
        copy.display()
    );
    let old = farm.path().join("old");
    fs::write(&old, script).expect("a file");
    let Some(cluster) = Cluster::start(&format!("chmod +x {0} && mount --bind {0} {program}", old.display()))
    else {
        return;
    };
    let (_, merge) = farm.submit(&cluster);
    cluster.until(&merge, &["COMPLETED"]);
    for node in cluster::NODES {
        let here = (1..=PARTS).filter(|part| farm.log(*part).contains(&format!("on {node},"))).count();
        println!("{here} parts were rendered on {node}");
        assert!(here > 0, "{}", farm.log(1));
    }
    assert_eq!(farm.merged(), farm.alone());
}

#[test]
#[ignore = "starts a cluster, as root, and measures"]
fn two_nodes_beside_one() {
    let Some(cluster) = Cluster::start("true") else { return };
    let mut seconds = Vec::new();
    for state in ["drain reason=measured", "resume"] {
        cluster.tell(Path::new("."), &format!("scontrol update NodeName=two State={state}"));
        let farm = Farm::new();
        let start = Instant::now();
        let (_, merge) = farm.submit(&cluster);
        cluster.until(&merge, &["COMPLETED"]);
        seconds.push(start.elapsed().as_secs_f64());
    }
    println!(
        "one node {:.1} s, two nodes {:.1} s: {:.2} times as fast",
        seconds[0],
        seconds[1],
        seconds[0] / seconds[1]
    );
}
