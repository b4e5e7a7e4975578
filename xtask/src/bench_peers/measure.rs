//! Wall time, CPU time and peak memory of one process.

use anyhow::{Context, Result, bail};
use std::process::{Command, Stdio};
use std::time::Instant;

/// The hidden subcommand that runs one process and says what it took.
///
/// The kernel reports the peak memory of *all* children of a process so far; a helper that has only the one child tells
/// them apart. It is small, because what it holds when it starts the child counts as the child's.
pub(crate) const MEASURE: &str = "measure";

/// What a process took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Usage {
    /// Seconds from start to end.
    pub wall: f64,
    /// Seconds of all threads, user and system.
    pub cpu: f64,
    /// Largest resident size in bytes.
    pub peak_bytes: f64,
}

/// Runs a command in a helper process; its output is dropped.
pub(super) fn measure(command: &[String]) -> Result<Usage> {
    let own = std::env::current_exe()?;
    let output = Command::new(own).arg(MEASURE).args(command).stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        bail!("`{}` failed", command.join(" "));
    }
    parse(&String::from_utf8_lossy(&output.stdout))
}

fn parse(line: &str) -> Result<Usage> {
    let numbers: Option<Vec<f64>> = line.split_whitespace().map(|n| n.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[wall, cpu, peak_bytes]) => Ok(Usage { wall, cpu, peak_bytes }),
        _ => bail!("found {line:?}, expected three numbers"),
    }
}

/// The helper's side: runs `command` and prints wall seconds, CPU seconds and peak bytes. True if it succeeded.
pub(crate) fn measure_child(command: &[&str]) -> Result<bool> {
    let [program, args @ ..] = command else { bail!("{MEASURE}: no command") };
    let start = Instant::now();
    let mut child = Command::new(program);
    let status = child.args(args).stdout(Stdio::null()).status().with_context(|| (*program).to_owned())?;
    let wall = start.elapsed().as_secs_f64();
    let (cpu, peak_bytes) = children()?;
    println!("{wall} {cpu} {peak_bytes}");
    Ok(status.success())
}

/// CPU seconds and peak bytes of the children that have ended.
#[cfg(target_os = "linux")]
fn children() -> Result<(f64, f64)> {
    use nix::sys::resource::{UsageWho, getrusage};
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN)?;
    let seconds = |t: nix::sys::time::TimeVal| t.tv_sec() as f64 + 1e-6 * t.tv_usec() as f64;
    // Linux counts in KiB.
    Ok((seconds(usage.user_time()) + seconds(usage.system_time()), 1024.0 * usage.max_rss() as f64))
}

#[cfg(not(target_os = "linux"))]
fn children() -> Result<(f64, f64)> {
    bail!("memory and CPU time of a process are measured on Linux only")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_helper_s_line_is_read_back() {
        assert!(parse("0.25 0.5 1024\n").is_ok_and(|u| u == Usage { wall: 0.25, cpu: 0.5, peak_bytes: 1024.0 }));
        assert!(parse("0.25 0.5").is_err() && parse("a b c").is_err() && parse("").is_err());
    }
}
