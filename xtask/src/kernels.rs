//! Looks for vector instructions that are calls.
//!
//! An intrinsic is one instruction where the code around it is compiled with its instruction set. Where it is not, the intrinsic
//! stays a function of its own, which is called for every register of numbers: more time, and the same results, so no
//! test sees it. Such a function leaves its name in the program.

use std::path::Path;

/// Module of the standard library that holds the intrinsics, as it stands in a mangled name.
const INTRINSICS: &str = "4core9core_arch";
/// Modules of the instruction sets that kernels are compiled for beside what every processor has.
const SETS: [&str; 5] = ["3avx", "4avx2", "3fma", "avx512", "4neon"];
/// Stands in the name of an intrinsic of numbers in double precision, as the kernels have them alone. Those of whole numbers are of packages
/// that are compiled without optimisation, where every intrinsic is a function.
const DOUBLES: [&str; 2] = ["_pd", "_f64"];
/// Prefixes of the mangled name of a function, behind the underscores: as Rust mangles, and as it did before.
const FUNCTIONS: [&str; 3] = ["RNv", "RINv", "ZN"];
/// The crate of the kernels, as it stands in a mangled name.
const KERNELS: &str = "8meshtone";

/// The intrinsics that are called as functions in the release build of the program, which must be there.
///
/// # Arguments
/// * `root` - folder of the workspace
///
/// # Errors
/// A program that cannot be read, or that holds no names of its functions.
pub fn problems(root: &Path) -> Result<Vec<String>, String> {
    let file = format!("meshtone{}", std::env::consts::EXE_SUFFIX);
    let program = root.join("target").join("release").join(file);
    let bytes = std::fs::read(&program).map_err(|error| format!("{}: {error}", program.display()))?;
    let is_function = |name: &&str| FUNCTIONS.iter().any(|start| name.starts_with(start));
    let functions: Vec<&str> = names(&bytes).filter(is_function).collect();
    if !functions.iter().any(|name| name.contains(KERNELS)) {
        return Err(format!("{}: holds no names of its functions", program.display()));
    }
    let called: Vec<&str> = functions.into_iter().filter(|name| is_intrinsic(name)).collect();
    let problem = || {
        format!(
            "{}: these intrinsics are functions that are called (`objdump -d` shows by whom); inline what calls them into \
             what is compiled for the instruction set, with `#[inline(always)]` and no closure handed to a function that is \
             not:\n  {}",
            program.display(),
            called.join("\n  ")
        )
    };
    Ok((!called.is_empty()).then(problem).into_iter().collect())
}

/// Names in a program's table of symbols, without the underscores before them, and whatever else is text between two zeros.
fn names(program: &[u8]) -> impl Iterator<Item = &str> {
    let pieces = program.split(|byte| *byte == 0);
    pieces.filter_map(|piece| std::str::from_utf8(piece).ok()).map(|name| name.trim_start_matches('_'))
}

/// Returns whether a mangled name is that of an intrinsic of one of the [`SETS`], not of a function with one of their types.
fn is_intrinsic(name: &str) -> bool {
    let Some((before, inside)) = name.split_once(INTRINSICS) else { return false };
    let path = FUNCTIONS.iter().find_map(|start| before.strip_prefix(start));
    // Only the namespaces of the path's parts and the crate's number: `NtNtNtCsgEmfK2I1SDS_`.
    let is_function = path.is_some_and(|path| {
        let crate_number = path.trim_start_matches("Nt");
        crate_number.is_empty() || crate_number.find('_') == Some(crate_number.len() - 1)
    });
    is_function
        && DOUBLES.iter().any(|name| inside.contains(name))
        && SETS.iter().any(|set| inside.contains(set))
}

#[cfg(test)]
mod tests {
    use super::{is_intrinsic, names};

    #[test]
    fn intrinsics_are_distinguished_from_functions_with_their_types() {
        assert!(is_intrinsic("RNvNtNtNtCsgEmfK2I1SDS_4core9core_arch3x863fma15__mm256_fmadd_pd"));
        assert!(is_intrinsic("RINvNtNtNtCsgEmfK2I1SDS_4core9core_arch3x863avx17__mm256_permute_pdKl5_E"));
        assert!(is_intrinsic("ZN4core9core_arch3x863avx13_mm256_add_pd17h0123456789abcdefE"));
        assert!(!is_intrinsic(
            "RINvNtCs4X4t9plMPHF_5alloc3vecNtNtNtCsgEmfK2I1SDS_4core9core_arch3x867___m256dE"
        ));
        assert!(!is_intrinsic(
            "RNvXs2_NtNtCsgEmfK2I1SDS_4core9core_arch3x86NtB5_7___m256dNtNtB9_3fmt5Debug3fmt"
        ));
        assert!(!is_intrinsic("ZN4core9core_arch3x864avx215_mm256_or_si25617h0123456789abcdefE"));
        assert!(!is_intrinsic("RNvNtCsgEmfK2I1SDS_4core3mem4swap"));
        // What detects which processor it is.
        assert!(!is_intrinsic("RNvNtNtNtCsgEmfK2I1SDS_4core9core_arch3x865xsave7__xgetbv"));
    }

    #[test]
    fn names_are_what_lies_between_zeros() {
        assert_eq!(
            names(b"\x7fELF\0_RNvA\0__ZNb\0\xff\xfe\0").collect::<Vec<_>>(),
            ["\x7fELF", "RNvA", "ZNb", ""]
        );
    }
}
