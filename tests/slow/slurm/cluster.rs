//! A Slurm of two nodes on this machine, which ends with the test.

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fmt::Write as _;
use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long the test waits for anything.
const PATIENCE: Duration = Duration::from_secs(600);

/// The daemons' programs, and where Debian has them.
const PROGRAMS: [&str; 3] = ["/usr/sbin/munged", "/usr/sbin/slurmctld", "/usr/sbin/slurmd"];

/// The names of the nodes.
pub const NODES: [&str; 2] = ["one", "two"];

/// A running cluster. Each node takes as many tasks at a time as it has CPUs.
pub struct Cluster {
    folder: TempDir,
    daemons: Vec<Child>,
    nodes: [Option<Child>; 2],
}

impl Cluster {
    /// Starts a cluster, or says why there can be none.
    ///
    /// The second node runs `before` in a mount namespace of its own before it starts: what that mounts, only its tasks
    /// see.
    pub fn start(before: &str) -> Option<Self> {
        if let Some(missing) = PROGRAMS.iter().find(|program| !Path::new(program).exists()) {
            println!("SKIPPED: there is no {missing}; `apt-get install slurm-wlm munge` installs it");
            return None;
        }
        let folder = TempDir::new().expect("a folder");
        if fs::metadata(folder.path()).expect("a folder").uid() != 0 {
            println!("SKIPPED: only root can start the daemons of a cluster");
            return None;
        }
        let at = |name: &str| folder.path().join(name).display().to_string();
        fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o755)).expect("root");
        let key: Vec<u8> = (0..1024_u32).map(|index| ((index * index) >> 3) as u8).collect();
        fs::write(at("key"), key).expect("a file");
        fs::set_permissions(at("key"), PermissionsExt::from_mode(0o400)).expect("root");
        fs::create_dir(at("cgroup")).expect("a folder");
        fs::write(at("cgroup.conf"), format!("CgroupPlugin=cgroup/v1\nCgroupMountpoint={}\n", at("cgroup")))
            .expect("a file");
        fs::write(at("slurm.conf"), configuration(&at)).expect("a file");
        let mut munged = Command::new(PROGRAMS[0]);
        munged.args(["--foreground", "--force"]).args([
            format!("--key-file={}", at("key")),
            format!("--socket={}", at("munge")),
            format!("--pid-file={}", at("munged.pid")),
            format!("--log-file={}", at("munged.log")),
            format!("--seed-file={}", at("munged.seed")),
        ]);
        let mut cluster = Self { folder, daemons: Vec::new(), nodes: [None, None] };
        cluster.daemons.push(cluster.spawn(munged, "munged"));
        let munge = cluster.path("munge");
        wait("munge", || munge.exists());
        let mut controller = Command::new(PROGRAMS[1]);
        controller.args(["-D", "-i"]);
        cluster.daemons.push(cluster.spawn(controller, "controller"));
        cluster.node(0, "true");
        cluster.node(1, before);
        wait("both nodes", || cluster.is_idle(0) && cluster.is_idle(1));
        Some(cluster)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn spawn(&self, mut command: Command, name: &str) -> Child {
        let log = fs::File::create(self.path(&format!("{name}.out"))).expect("a file");
        command.env("SLURM_CONF", self.path("slurm.conf")).stdin(Stdio::null());
        command.stdout(log.try_clone().expect("a file")).stderr(log).spawn().expect("a daemon")
    }

    /// Starts the daemon of a node.
    fn node(&mut self, index: usize, before: &str) {
        let mut command = Command::new("unshare");
        let start = format!("{before} && exec {} -D -N {}", PROGRAMS[2], NODES[index]);
        command.args(["--mount", "--propagation", "private", "sh", "-c", &start]);
        self.nodes[index] = Some(self.spawn(command, NODES[index]));
    }

    /// Runs a command of Slurm in a folder, or a line of commands; returns its output.
    pub fn run(&self, folder: &Path, line: &str) -> Output {
        let mut command = Command::new("bash");
        command.args(["-c", line]).current_dir(folder).env("SLURM_CONF", self.path("slurm.conf"));
        command.output().expect("bash runs")
    }

    /// Returns what a command prints, which must succeed.
    pub fn tell(&self, folder: &Path, line: &str) -> String {
        let output = self.run(folder, line);
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert!(output.status.success(), "{line}: {}", text(&output.stderr));
        text(&output.stdout)
    }

    fn is_idle(&self, index: usize) -> bool {
        let output =
            self.run(self.folder.path(), &format!("sinfo --noheader --format=%T --nodes={}", NODES[index]));
        String::from_utf8_lossy(&output.stdout).trim() == "idle"
    }

    /// Returns the state of a job and of all tasks of an array, one a line.
    pub fn states(&self, job: &str) -> String {
        self.tell(
            self.folder.path(),
            &format!("squeue --noheader --array --states=all --format='%T %N %A' --job={job}"),
        )
    }

    /// Waits until a job, or each task of an array, is in one of these states.
    pub fn until(&self, job: &str, states: &[&str]) {
        wait(&format!("{states:?} of job {job}"), || {
            // A task that is queued again for a node's failure waits for two minutes, unless it is told otherwise.
            for line in self.states(job).lines().filter(|line| line.starts_with("PENDING")) {
                if let Some(id) = line.split_whitespace().last() {
                    self.run(self.folder.path(), &format!("scontrol update JobId={id} StartTime=now"));
                }
            }
            self.states(job).lines().all(|line| states.iter().any(|state| line.starts_with(state)))
        });
    }

    /// Kills the daemon of a node and everything that runs there, as if its power failed; returns the jobs that ran.
    pub fn kill(&mut self, index: usize, job: &str) -> usize {
        let states = self.states(job);
        let here = states.lines().filter(|line| line.starts_with("RUNNING") && line.contains(NODES[index]));
        let ids: Vec<_> = here.filter_map(|line| line.split_whitespace().last()).collect();
        let mut daemon = self.nodes[index].take().expect("a running node");
        daemon.kill().expect("a daemon");
        daemon.wait().expect("its end");
        for id in &ids {
            // The steps of a job have its number in their names, `slurmstepd: [7.batch]`.
            let steps = processes(|line| line.starts_with(&format!("slurmstepd: [{id}.")));
            assert!(!steps.is_empty(), "job {id} has a step");
            steps.into_iter().for_each(kill_tree);
        }
        ids.len()
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for child in self.nodes.iter_mut().flatten().chain(self.daemons.iter_mut().rev()) {
            kill_tree(child.id() as i32);
            let _ = child.wait();
        }
        if thread::panicking() {
            for name in ["controller.out", "one.out", "two.out"] {
                println!("== {name}\n{}", fs::read_to_string(self.path(name)).unwrap_or_default());
            }
        }
    }
}

/// Returns the configuration of a cluster whose files are where `at` says.
fn configuration(at: &dyn Fn(&str) -> String) -> String {
    let host = fs::read_to_string("/proc/sys/kernel/hostname").expect("a name");
    let host = host.trim().split('.').next().expect("a name");
    let listeners = [(); 3].map(|()| TcpListener::bind("127.0.0.1:0").expect("a free port"));
    let [controller, one, two] = listeners.map(|listener| listener.local_addr().expect("a port").port());
    let mut text = format!(
        "ClusterName=tabray
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
AuthType=auth/munge
AuthInfo=socket={}
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={}
SlurmdSpoolDir={}-%n
SlurmctldPidFile={}
SlurmdPidFile={}-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmdTimeout=5
KillWait=2
MinJobAge=86400
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
",
        at("munge"),
        at("state"),
        at("spool"),
        at("controller.pid"),
        at("slurmd.pid"),
    );
    for (name, port) in NODES.iter().zip([one, two]) {
        let _ = writeln!(
            text,
            "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=2 RealMemory=500"
        );
    }
    text
}

/// Waits for something that must happen.
pub fn wait(what: &str, happens: impl Fn() -> bool) {
    let start = Instant::now();
    while !happens() {
        assert!(start.elapsed() < PATIENCE, "{what} did not come");
        thread::sleep(Duration::from_millis(200));
    }
}

/// Returns the processes whose command lines a condition holds for.
fn processes(is_meant: impl Fn(&str) -> bool) -> Vec<i32> {
    let entries = fs::read_dir("/proc").expect("the processes").filter_map(Result::ok);
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let line = |id: &i32| fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
    numbers.filter(|id| is_meant(&String::from_utf8_lossy(&line(id)).replace('\0', " "))).collect()
}

/// Kills a process and all that it has started.
fn kill_tree(id: i32) {
    let _ = kill(Pid::from_raw(id), Signal::SIGSTOP);
    let children = fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap_or_default();
    children.split_whitespace().filter_map(|child| child.parse().ok()).for_each(kill_tree);
    let _ = kill(Pid::from_raw(id), Signal::SIGKILL);
}
