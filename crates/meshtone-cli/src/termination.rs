//! Clean-up where the program is asked to end: by Ctrl-C, by the system, by a terminal that is closed.

#[cfg(unix)]
use {
    meshtone_io::own_file::remove_own,
    signal_hook::consts::{SIGHUP, SIGINT, SIGTERM},
    signal_hook::iterator::Signals,
    signal_hook::low_level::emulate_default_handler,
};

/// Lets the program remove its unfinished files before it ends as it would have ended. What is finished stays.
///
/// On other systems, and where the program is killed, the next one that writes there removes them.
#[cfg(unix)]
pub fn remove_unfinished_files_at_end() {
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|&signal| !is_ignored(signal));
    let Ok(mut signals) = Signals::new(heard) else { return };
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            remove_own();
            let _ = emulate_default_handler(signal);
            std::process::exit(128 + signal);
        }
    });
}

/// Returns whether whoever started the program lets it ignore a signal, as `nohup` and the background of a script do: to listen to it would
/// be to hear it again. Only Linux says so in a file.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}

/// The next program that writes where this one has written removes what it leaves behind.
#[cfg(not(unix))]
pub fn remove_unfinished_files_at_end() {}
