//! The tests of the Python package, where its wheel is installed.

use std::path::Path;
use std::process::Command;

use crate::environment::pip_install;
use crate::step::StepRunner;
use crate::surroundings::unusual;

/// Programs that the tests of the page need to try it in a browser, each by one of its names.
const BROWSER: [&[&str]; 2] = [&["chromium", "chromium-browser", "google-chrome"], &["chromedriver"]];

/// Arguments of pytest for the examples in the package's documentation.
const EXAMPLES: [&str; 5] =
    ["--quiet", "--doctest-modules", "--doctest-ignore-import-errors", "--pyargs", "meshtone"];
/// Arguments of mypy: what is typed.
const TYPES: [&str; 6] = [
    "--config-file=pyproject.toml",
    "python/meshtone",
    "python/tests",
    "python/gallery",
    "python/validation",
    "python/benchmarks",
];

/// Returns whether a program is found by its name.
fn is_installed(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

/// Installs a wheel beside what its tests need and tests the package there: its tests, the examples in its
/// documentation, its types.
///
/// # Arguments
/// * `python` - interpreter of the checks' environment
/// * `wheel` - file of the wheel
///
/// # Errors
/// The exit code of what failed.
pub fn test(row: &StepRunner, python: &Path, wheel: &Path) -> Result<(), u8> {
    install(row, python, wheel)?;
    let surroundings = unusual(row)?;
    let run = |name: &str, module: &str, arguments: &[&str]| {
        let mut program = Command::new(python);
        program.args(["-m", module]).args(arguments).envs(surroundings.iter().cloned());
        row.step(name, || row.program(&mut program))
    };
    run("Python tests", "pytest", &["--quiet", "python/tests"])?;
    if let Some(missing) = BROWSER.into_iter().find(|names| !names.iter().any(|name| is_installed(name))) {
        println!("    the page was not tried in a browser: {} is not installed", missing[0]);
    }
    run("Python examples", "pytest", &EXAMPLES)?;
    run("Python types", "mypy", &TYPES)?;
    run("Python stubs", "mypy.stubtest", &["meshtone._core"])
}

/// Runs those tests of the package that count over many simulations, and prints what they print.
///
/// # Arguments
/// * `python` - interpreter of the checks' environment
/// * `wheel` - file of the wheel
///
/// # Errors
/// The exit code of what failed.
pub fn measure(row: &StepRunner, python: &Path, wheel: &Path) -> Result<(), u8> {
    install(row, python, wheel)?;
    let mut pytest = Command::new(python);
    pytest.args(["-m", "pytest", "--quiet", "-m", "measurement", "-s", "python/tests"]);
    row.step("Python measurements", || row.program(&mut pytest))
}

/// Installs the wheel beside what its tests need.
fn install(row: &StepRunner, python: &Path, wheel: &Path) -> Result<(), u8> {
    row.step("Python wheel, installed", || {
        pip_install(row, python, python, |pip| pip.args(["--force-reinstall", "--no-deps"]).arg(wheel))
    })
}
