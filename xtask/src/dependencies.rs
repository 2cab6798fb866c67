//! A check that `deny.toml` allows the packages on which the workspace depends.
//!
//! It is a part of what `cargo deny` checks, and needs no network: sources, doubled versions and the packages of listed advisories
//! are those of `Cargo.lock`, for all platforms; licences are those of the packages that this platform needs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Stdio};

use toml::{Table, Value};

use crate::files;

/// A package of `Cargo.lock`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Package {
    name: String,
    version: String,
    /// Its source; none of the workspace's own.
    source: Option<String>,
}

/// The dependencies that `deny.toml` does not allow, and its exceptions that are not needed any more.
///
/// # Arguments
/// * `root` - folder of the workspace
///
/// # Errors
/// Something that cannot be read.
pub fn problems(root: &Path) -> Result<Vec<String>, String> {
    let rules = read_table(&root.join("deny.toml"))?;
    let packages = packages(&read_table(&root.join("Cargo.lock"))?);
    let others = [foreign(&rules, &packages), doubled(&rules, &packages), unlisted(&rules, &packages)];
    Ok([others.concat(), refused(&rules, &licences(root)?)].concat())
}

fn read_table(path: &Path) -> Result<Table, String> {
    let text = files::read(path).map_err(|error| error.to_string())?;
    text.parse().map_err(|error| format!("{}: {error}", path.display()))
}

fn packages(lock: &Table) -> Vec<Package> {
    let packages = lock.get("package").and_then(Value::as_array).into_iter().flatten();
    let text = |package: &Value, key: &str| package.get(key).and_then(Value::as_str).map(str::to_owned);
    let package = |package: &Value| {
        let (name, version) = (text(package, "name")?, text(package, "version")?);
        Some(Package { name, version, source: text(package, "source") })
    };
    packages.filter_map(package).collect()
}

/// The licence of every package that this platform needs, as Cargo knows it.
fn licences(root: &Path) -> Result<BTreeMap<String, String>, String> {
    let run = |program: &str, arguments: &[&str]| {
        let run = Command::new(program).args(arguments).current_dir(root).stderr(Stdio::inherit()).output();
        let output = run.map_err(|error| format!("{program}: {error}"))?;
        let text = || String::from_utf8_lossy(&output.stdout).into_owned();
        if output.status.success() {
            Ok(text())
        } else {
            Err(format!("{program} {} failed", arguments.join(" ")))
        }
    };
    let about = run("rustc", &["--version", "--verbose"])?;
    let host = about.lines().find_map(|line| line.strip_prefix("host: ")).ok_or("rustc names no platform")?;
    let arguments = ["metadata", "--offline", "--locked", "--format-version", "1", "--filter-platform", host];
    let metadata: serde_json::Value = serde_json::from_str(&run("cargo", &arguments)?)
        .map_err(|error| format!("cargo metadata: {error}"))?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let licence = |package: &serde_json::Value| {
        let name = package["name"].as_str()?.to_owned();
        Some((name, package["license"].as_str().unwrap_or_default().to_owned()))
    };
    Ok(packages.filter_map(licence).collect())
}

/// The entries of a list in `deny.toml`.
fn list<'r>(rules: &'r Table, section: &str, key: &str) -> &'r [Value] {
    let list = rules.get(section).and_then(|section| section.get(key)).and_then(Value::as_array);
    list.map_or(&[], Vec::as_slice)
}

fn texts(list: &[Value]) -> impl Iterator<Item = &str> {
    list.iter().filter_map(Value::as_str)
}

/// A text of an entry, empty where it has none.
fn text<'r>(entry: &'r Value, key: &str) -> &'r str {
    entry.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// Packages from elsewhere than the registries that are allowed.
fn foreign(rules: &Table, packages: &[Package]) -> Vec<String> {
    let allowed: Vec<&str> = texts(list(rules, "sources", "allow-registry")).collect();
    let from =
        |source: &str| source.strip_prefix("registry+").is_some_and(|registry| allowed.contains(&registry));
    let foreign = packages.iter().filter_map(|Package { name, version, source }| {
        let source = source.as_deref().filter(|source| !from(source))?;
        Some(format!("{name} {version} comes from {source}, which [sources] of deny.toml does not allow"))
    });
    foreign.collect()
}

/// Packages of several versions, and exceptions that are none any more.
fn doubled(rules: &Table, packages: &[Package]) -> Vec<String> {
    let skip: Vec<(&str, &str)> = list(rules, "bans", "skip")
        .iter()
        .map(|entry| text(entry, "crate").split_once('@').unwrap_or((text(entry, "crate"), "")))
        .collect();
    let is_skipped = |package: &&Package| skip.iter().any(|spec| is_of(package, *spec));
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for package in packages.iter().filter(|package| !is_skipped(package)) {
        versions.entry(&package.name).or_default().insert(&package.version);
    }
    let doubled = versions.into_iter().filter(|(_, versions)| versions.len() > 1).map(|(name, versions)| {
        let versions: Vec<&str> = versions.into_iter().collect();
        format!(
            "{name} is there in several versions, {}: bring them together, or list all but one with a reason under skip in deny.toml",
            versions.join(" and ")
        )
    });
    let unneeded = skip.iter().filter(|spec| {
        let others = |package: &&Package| package.name == spec.0 && !is_of(package, **spec);
        !packages.iter().any(|package| is_of(package, **spec))
            || !packages.iter().any(|package| others(&package))
    });
    let unneeded = unneeded.map(|(name, version)| {
        format!("{name}@{version} under skip in deny.toml is not doubled any more: remove it")
    });
    doubled.chain(unneeded).collect()
}

/// Returns whether a package is one of a name and a version, of which the last numbers may be left out.
fn is_of(package: &Package, (name, version): (&str, &str)) -> bool {
    let rest = package.version.strip_prefix(version);
    package.name == name
        && rest.is_some_and(|rest| version.is_empty() || rest.is_empty() || rest.starts_with('.'))
}

/// Advisories that nothing is left of, or that nothing is said of.
fn unlisted(rules: &Table, packages: &[Package]) -> Vec<String> {
    let unlisted = list(rules, "advisories", "ignore").iter().filter_map(|entry| {
        let (id, reason) = (text(entry, "id"), text(entry, "reason"));
        let Some((name, _)) = reason.split_once(": ") else {
            return Some(format!("advisory {id} in deny.toml has no reason that begins with its package"));
        };
        let is_there = packages.iter().any(|package| package.name == name);
        (!is_there).then(|| format!("{name} of advisory {id} in deny.toml is not there any more: remove it"))
    });
    unlisted.collect()
}

/// Packages whose licence is not allowed, and exceptions that are none any more.
fn refused(rules: &Table, licences: &BTreeMap<String, String>) -> Vec<String> {
    let allowed: Vec<&str> = texts(list(rules, "licenses", "allow")).collect();
    let exceptions = list(rules, "licenses", "exceptions");
    let excepted = |package: &str| {
        let own = exceptions.iter().find(|entry| text(entry, "crate") == package)?;
        own.get("allow").and_then(Value::as_array)
    };
    let refused = licences.iter().filter_map(|(name, licence)| {
        let own = excepted(name).map_or(&[][..], Vec::as_slice);
        let allowed: Vec<&str> = allowed.iter().copied().chain(texts(own)).collect();
        (!is_allowed(licence, &allowed)).then(|| {
            let stated = if licence.is_empty() { "no licence" } else { licence };
            format!("{name} has {stated}, which [licenses] of deny.toml does not allow")
        })
    });
    let unneeded = exceptions.iter().map(|entry| text(entry, "crate")).filter(|name| {
        // Of a package that another platform needs nothing is known here.
        licences.get(*name).is_some_and(|licence| is_allowed(licence, &allowed))
    });
    let unneeded = unneeded.map(|name| format!("{name} needs no exception in deny.toml any more: remove it"));
    refused.chain(unneeded).collect()
}

/// Stand for an expression in parentheses that cannot, or can, be satisfied.
const DECIDED: [&str; 2] = ["REFUSED", "ALLOWED"];

/// Returns whether an expression of licences can be satisfied by those that are allowed. A term that is no licence never is allowed.
///
/// Source: SPDX specification 3.0, annex "SPDX license expressions"; `/` for OR is what packages wrote before.
fn is_allowed(expression: &str, allowed: &[&str]) -> bool {
    let mut open = expression.replace('/', " OR ");
    // The last parenthesis that opens is an innermost one.
    while let Some((before, rest)) = open.rsplit_once('(') {
        let Some((inside, after)) = rest.split_once(')') else { return false };
        open = format!("{before}{}{after}", DECIDED[usize::from(is_flat_allowed(inside, allowed))]);
    }
    is_flat_allowed(&open, allowed)
}

/// The same of an expression without parentheses, in which AND binds closer than OR.
fn is_flat_allowed(expression: &str, allowed: &[&str]) -> bool {
    let is_licence = |text: &str| text == DECIDED[1] || allowed.contains(&text);
    expression.split(" OR ").any(|all| all.split(" AND ").all(|licence| is_licence(licence.trim())))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: &str = r#"
        [advisories]
        ignore = [{ id = "RUSTSEC-1", reason = "paste: done" }, { id = "RUSTSEC-2", reason = "gone: was" }]
        [licenses]
        allow = ["MIT", "Apache-2.0 WITH LLVM-exception"]
        exceptions = [{ crate = "zero", allow = ["CC0-1.0"] }, { crate = "paste", allow = ["ISC"] }]
        [bans]
        skip = [{ crate = "syn@1", reason = "r" }, { crate = "rand@0.8", reason = "r" }]
        [sources]
        allow-registry = ["https://index"]
    "#;

    fn lock() -> Vec<Package> {
        let package = |name: &str, version: &str, source: Option<&str>| Package {
            name: name.to_owned(),
            version: version.to_owned(),
            source: source.map(str::to_owned),
        };
        let index = Some("registry+https://index");
        vec![
            package("own", "0.1.0", None),
            package("paste", "1.0.15", index),
            package("syn", "1.0.1", index),
            package("syn", "2.0.1", index),
            package("zip", "6.0.0", index),
            package("zip", "9.0.0", index),
            package("rand", "0.8.1", index),
            package("git", "1.0.0", Some("git+https://elsewhere")),
        ]
    }

    fn rules() -> Table {
        RULES.parse().unwrap_or_default()
    }

    #[test]
    fn sources_versions_and_advisories_are_those_that_are_listed() {
        let rules = rules();
        let problems =
            [foreign(&rules, &lock()), doubled(&rules, &lock()), unlisted(&rules, &lock())].concat();
        let begins = [
            "git 1.0.0 comes from git+https://elsewhere",
            "zip is there in several versions, 6.0.0 and 9.0.0",
            "rand@0.8 under skip",
            "gone of advisory RUSTSEC-2",
        ];
        assert_eq!(problems.len(), begins.len(), "{problems:?}");
        assert!(
            problems.iter().zip(begins).all(|(problem, begin)| problem.starts_with(begin)),
            "{problems:?}"
        );
    }

    #[test]
    fn licences_are_those_that_are_allowed_or_excepted() {
        let licence = |(name, licence): (&str, &str)| (name.to_owned(), licence.to_owned());
        let licences =
            [("zero", "CC0-1.0"), ("other", "CC0-1.0"), ("paste", "MIT OR Apache-2.0"), ("none", "")];
        let problems = refused(&rules(), &licences.map(licence).into());
        let begins = ["none has no licence", "other has CC0-1.0", "paste needs no exception"];
        assert!(
            problems.len() == 3 && problems.iter().zip(begins).all(|(p, b)| p.starts_with(b)),
            "{problems:?}"
        );
    }

    #[test]
    fn expressions_of_licences_are_understood() {
        let allowed = ["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"];
        for good in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0 OR (MIT AND Zlib)",
            "Apache-2.0 WITH LLVM-exception",
            "ISC AND ISC OR MIT",
        ] {
            assert!(is_allowed(good, &allowed), "{good}");
        }
        for bad in [
            "",
            "ISC",
            "MIT AND ISC",
            "Apache-2.0",
            "MIT OR",
            "(MIT",
            "MIT)",
            "MIT Zlib",
            "MIT AND (ISC OR GPL-3.0)",
        ] {
            assert!(!is_allowed(bad, &allowed), "{bad}");
        }
    }
}
