//! What work took: of the wall clock, and of all the process's threads.

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

#[cfg(test)]
mod tests {
    use super::*;

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
