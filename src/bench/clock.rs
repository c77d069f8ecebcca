//! What work took: of the wall clock, of all the process's threads, and of memory.

use std::time::Instant;

/// Seconds of two clocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seconds {
    /// User and system time of all threads; NaN where the system does not say.
    pub cpu: f64,
    /// What passed.
    pub wall: f64,
}

/// Does `work` and says what it took.
///
/// # Errors
/// Those of the work.
pub fn timed<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, Seconds), E> {
    let (cpu, wall) = (cpu_seconds(), Instant::now());
    let done = work()?;
    Ok((done, Seconds { cpu: cpu_seconds() - cpu, wall: wall.elapsed().as_secs_f64() }))
}

/// User and system time of this process so far, all threads together; NaN where the system does not say.
#[cfg(unix)]
pub fn cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Nobody says.
#[cfg(not(unix))]
pub fn cpu_seconds() -> f64 {
    f64::NAN
}

/// The most memory that this process has held so far; where the system says it, as Linux does.
pub fn host_peak_bytes() -> Option<u64> {
    peak_of(&std::fs::read_to_string("/proc/self/status").ok()?)
}

fn peak_of(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_grows_with_what_is_held() {
        assert_eq!(peak_of("Name:\tx\nVmHWM:\t    1234 kB\nVmRSS:\t 1 kB\n"), Some(1234 * 1024));
        assert_eq!(peak_of("VmHWM: many kB"), None);
        let Some(before) = host_peak_bytes() else { return };
        let held = std::hint::black_box(vec![1_u8; 1 << 28]);
        let after = host_peak_bytes().expect("said before");
        assert!(held.len() as u64 <= after && before <= after, "{before} {after}");
    }

    #[test]
    fn work_takes_time_and_waiting_none_of_the_processor() {
        let busy = || {
            let begun = Instant::now();
            let mut sum = 0_u64;
            while begun.elapsed().as_millis() < 20 {
                sum = std::hint::black_box(sum.wrapping_add(1));
            }
            Ok::<_, ()>(sum)
        };
        let (_, seconds) = timed(busy).unwrap();
        assert!(seconds.wall >= 0.02 && seconds.cpu > 0.0, "{seconds:?}");
        assert!(timed(|| Err::<(), _>("no")).is_err());
    }
}
