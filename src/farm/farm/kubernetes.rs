//! The manifests of two Kubernetes jobs.

use super::job::Job;
use std::path::Path;
use tabray_core::text;

/// The longest name that Kubernetes takes, less that of a pod's own ending, in bytes.
const LONGEST: usize = 40;

/// Returns a name for the jobs of an image: in lower case, of letters, digits and hyphens.
pub fn name(image: &Path) -> String {
    let stem = image.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let letters = stem.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' });
    let name: String = letters.take(LONGEST).collect();
    let name = name.trim_matches('-');
    if name.is_empty() { "tabray".to_owned() } else { name.to_owned() }
}

/// Returns the commands that run the jobs.
pub fn steps(name: &str) -> String {
    format!(
        "after `kubectl apply`, this puts the parts together:
kubectl wait --for=condition=complete --timeout=-1s job/{name}-parts &&
    kubectl patch job/{name}-merge --patch '{{\"spec\":{{\"suspend\":false}}}}'"
    )
}

/// Returns the manifests of both jobs.
pub fn manifests(job: &Job, name: &str, container: &str, claim: &str) -> String {
    let parts = job.parts;
    // Kubernetes replaces `$(NAME)`, unless its dollar is doubled.
    let part = format!("exec tabray {}", job.part("@").replace("$(", "$$("));
    let part = part.replacen("--part @/", "--part \"$((JOB_COMPLETION_INDEX + 1))\"/", 1);
    let part = pod(&["sh", "-c", &part], container, claim);
    let last =
        pod(&["sh", "-c", &format!("exec tabray {}", job.last.replace("$(", "$$("))], container, claim);
    format!(
        "# Renders the parts; a part that a node evicts is rendered again, and bad input ends the job at once.
apiVersion: batch/v1
kind: Job
metadata:
  name: {name}-parts
spec:
  completions: {parts}
  parallelism: {parts}
  completionMode: Indexed
  backoffLimitPerIndex: 3
  maxFailedIndexes: 0
  podFailurePolicy:
    rules:
      - action: Ignore
        onPodConditions:
          - type: DisruptionTarget
            status: \"True\"
      - action: FailJob
        onExitCodes:
          containerName: tabray
          operator: In
          values: [2]
{part}---
# Puts the parts together, once it is no longer suspended.
apiVersion: batch/v1
kind: Job
metadata:
  name: {name}-merge
spec:
  suspend: true
  backoffLimit: 3
{last}"
    )
}

/// Returns the template of a pod that runs a command.
fn pod(command: &[&str], container: &str, claim: &str) -> String {
    // Strings in JSON are strings in YAML.
    let [command, container, claim] = [text::json(&command), text::json(&container), text::json(&claim)];
    format!(
        "  template:
    spec:
      restartPolicy: Never
      containers:
        - name: tabray
          image: {container}
          workingDir: /scenes
          command: {command}
          resources:
            requests: {{cpu: \"4\", memory: 1Gi}}
            limits: {{memory: 1Gi}}
          volumeMounts:
            - {{name: scenes, mountPath: /scenes}}
      volumes:
        - name: scenes
          persistentVolumeClaim: {{claimName: {claim}}}
"
    )
}
