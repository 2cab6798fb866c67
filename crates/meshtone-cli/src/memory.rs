//! How much memory there is.

use std::fs;

use meshtone::scenario::MemoryLimit;

/// How much memory a simulation may need on this machine.
pub fn limit() -> MemoryLimit {
    available_bytes().map_or_else(MemoryLimit::default, |free_bytes| MemoryLimit::Machine { free_bytes })
}

/// (bytes) Memory that can be used now without swapping, where the system says so (Linux does).
fn available_bytes() -> Option<u64> {
    let machine = fs::read_to_string("/proc/meminfo").ok().and_then(|text| available_in(&text));
    machine.into_iter().chain(left_to_container()).min()
}

fn available_in(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

fn left_to_container() -> Option<u64> {
    let number = |file: &str| fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let limit = number("/sys/fs/cgroup/memory.max")?;
    Some(limit.saturating_sub(number("/sys/fs/cgroup/memory.current")?))
}

#[cfg(test)]
mod tests {
    use super::available_in;

    #[test]
    fn meminfo() {
        let text = "MemTotal:       24689764 kB\nMemAvailable:   23000000 kB\nBuffers: 1 kB\n";
        assert_eq!(available_in(text), Some(23_000_000 * 1024));
        assert_eq!(available_in("MemTotal: 1 kB\n"), None);
    }
}
