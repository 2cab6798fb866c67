//! How much memory there is for what is read and simulated.

use std::fs;

use meshtone::scenario::MemoryLimit;

/// How much memory a simulation, or what is read of a file, may take: what was [set](MemoryLimit::set) for the program, or else what
/// is free on this machine, where the system says so, and at most
/// [`MEMORY_LIMIT_BYTES`](meshtone::scenario::MEMORY_LIMIT_BYTES).
pub fn limit() -> MemoryLimit {
    let machine = || Some(MemoryLimit::Machine { free_bytes: available_bytes()? });
    MemoryLimit::of_program().or_else(machine).unwrap_or_default()
}

/// (bytes) Memory that can be used now without swapping, where the system says so (Linux does).
fn available_bytes() -> Option<u64> {
    let machine = fs::read_to_string("/proc/meminfo").ok().and_then(|text| available_in(&text));
    machine.into_iter().chain(available_to_container()).min()
}

fn available_in(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

fn available_to_container() -> Option<u64> {
    let number = |file: &str| fs::read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let limit = number("/sys/fs/cgroup/memory.max")?;
    let current = number("/sys/fs/cgroup/memory.current")?;
    let statistics = fs::read_to_string("/sys/fs/cgroup/memory.stat").unwrap_or_default();
    Some(limit.saturating_sub(current.saturating_sub(reclaimable_in(&statistics))))
}

/// (bytes) Of files that were read a while ago: they count as a container's, and are let go of as soon as it needs memory.
fn reclaimable_in(statistics: &str) -> u64 {
    let line = statistics.lines().find_map(|line| line.strip_prefix("inactive_file "));
    line.and_then(|number| number.trim().parse().ok()).unwrap_or(0)
}

/// (bytes) An amount of memory as a user writes it: `2GB`, `1.5 GiB`, `300 MB`, or a number of bytes.
///
/// # Arguments
/// * `text` - the amount
///
/// # Errors
/// It is none, or none above 0.
///
/// ```
/// use meshtone_io::memory::parse_bytes;
///
/// assert_eq!(parse_bytes("2GB"), Ok(2_000_000_000));
/// assert_eq!(parse_bytes("1.5 GiB"), Ok(3 << 29));
/// assert_eq!(parse_bytes("4096"), Ok(4096));
/// assert_eq!(parse_bytes("2 potatoes").unwrap_err(), "must be an amount of memory such as 2GB, 1.5GiB or 300MB");
/// ```
pub fn parse_bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 10] = [
        ("", 1.0),
        ("B", 1.0),
        ("KB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("TB", 1e12),
        ("KIB", 1024.0),
        ("MIB", 1048576.0),
        ("GIB", 1073741824.0),
        ("TIB", 1099511627776.0),
    ];
    let text = text.trim();
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit = unit.trim().to_uppercase();
    let size = UNITS.iter().find(|(name, _)| *name == unit).map(|(_, bytes)| bytes);
    let bytes = size.and_then(|size| Some(number.parse::<f64>().ok()? * size));
    let bytes = bytes.filter(|bytes| (1.0..1e18).contains(bytes)).map(|bytes| bytes as u64);
    bytes.ok_or_else(|| "must be an amount of memory such as 2GB, 1.5GiB or 300MB".to_string())
}

#[cfg(test)]
mod tests {
    use super::{available_in, parse_bytes, reclaimable_in};

    #[test]
    fn meminfo() {
        let text = "MemTotal:       24689764 kB\nMemAvailable:   23000000 kB\nBuffers: 1 kB\n";
        assert_eq!(available_in(text), Some(23_000_000 * 1024));
        assert_eq!(available_in("MemTotal: 1 kB\n"), None);
    }

    #[test]
    fn statistics_of_a_container() {
        let text = "anon 4096\nfile 12288\ninactive_anon 1\nactive_file 4096\ninactive_file 8192\n";
        assert_eq!(reclaimable_in(text), 8192);
        assert_eq!(reclaimable_in("anon 4096\nworkingset_refault_file 7\n"), 0);
        assert_eq!(reclaimable_in(""), 0);
    }

    #[test]
    fn amounts() {
        assert_eq!(parse_bytes("300 mb"), Ok(300_000_000));
        assert_eq!(parse_bytes("1TiB"), Ok(1 << 40));
        for wrong in ["", "0", "-1GB", "GB", "1e9", "nan", "inf GB", "99999999TB", "1.2.3GB"] {
            assert!(parse_bytes(wrong).is_err(), "{wrong}");
        }
    }
}
