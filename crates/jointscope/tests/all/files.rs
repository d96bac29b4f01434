//! No files of a crate use each other in a circle: each can be read after those that it stands on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Names of a module and of those that hold it, from the crate's root; or of what it holds.
type Names = Vec<String>;

/// A file's code without comments and tests.
fn code(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let mut code = lines.collect::<Vec<_>>().join("\n");
    while let Some(start) = code.find("#[cfg(test)]") {
        let item = &code[start..];
        let (open, semicolon) = (item.find('{'), item.find(';').unwrap_or(item.len() - 1));
        let length = match open.filter(|open| *open < semicolon) {
            Some(open) => open + closed(&item[open..]),
            None => semicolon + 1,
        };
        code.replace_range(start..start + length, "");
    }
    code
}

/// Length of a text up to the end of the braces that it begins with.
fn closed(text: &str) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 {
            return at + 1;
        }
    }
    text.len()
}

/// Every path that a tree of imports stands for: `a::{b, c::d}`.
fn paths(tree: &str) -> Vec<String> {
    let Some((before, inside)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or(tree);
        return vec![path.split_whitespace().collect()];
    };
    let (mut depth, mut parts) = (0, vec![String::new()]);
    for c in inside.trim_end().strip_suffix('}').unwrap_or(inside).chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match (c, depth) {
            (',', 0) => parts.push(String::new()),
            _ => parts.iter_mut().last().unwrap().push(c),
        }
    }
    let parts = parts.iter().map(|part| part.trim()).filter(|part| !part.is_empty());
    parts.flat_map(|part| paths(&format!("{}{part}", before.trim()))).collect()
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The files of a crate, with what each of them imports or names: an absolute path, and whether it is
/// exported again.
struct Files {
    uses: BTreeMap<Names, Vec<(Names, bool)>>,
    /// By module and name, the path that an import stands for.
    imported: BTreeMap<(Names, String), Names>,
}

impl Files {
    fn of(source: &Path) -> Self {
        let codes = codes_below(source);
        let mut files = Files { uses: BTreeMap::new(), imported: BTreeMap::new() };
        for (module, code) in &codes {
            let (imports, rest) = imports(code);
            let mut uses = Vec::new();
            for (path, exported) in imports {
                let Some(mut path) = absolute(&path, module, &codes) else { continue };
                let is_module = path.last().is_some_and(|last| last == "self");
                if is_module {
                    path.pop();
                } else if let Some(name) = path.last() {
                    files.imported.insert((module.clone(), name.clone()), path.clone());
                }
                uses.push((path, exported));
            }
            uses.extend(
                named(&rest).iter().filter_map(|path| Some((absolute(path, module, &codes)?, false))),
            );
            files.uses.insert(module.clone(), uses);
        }
        files
    }

    /// The module that holds what a path names.
    fn module(&self, path: &[String], depth: usize) -> Names {
        let mut module = Names::new();
        for (index, name) in path.iter().enumerate() {
            module.push(name.clone());
            if self.uses.contains_key(&module) {
                continue;
            }
            module.pop();
            let from_elsewhere = self.imported.get(&(module.clone(), name.clone()));
            return match from_elsewhere.filter(|other| depth > 0 && other.as_slice() != path) {
                Some(other) => self.module(&[other, &path[index + 1..]].concat(), depth - 1),
                None => module,
            };
        }
        module
    }

    /// By file, the others that it uses; that a module hands on what is inside of it is no use of it.
    fn used(&self) -> BTreeMap<Names, BTreeSet<Names>> {
        let of = |(module, uses): (&Names, &Vec<(Names, bool)>)| {
            let used = uses.iter().map(|(path, exported)| (self.module(path, 6), exported));
            let others = used
                .filter(|(other, exported)| other != module && !(**exported && other.starts_with(module)));
            (module.clone(), others.map(|(other, _)| other).collect())
        };
        self.uses.iter().map(of).collect()
    }
}

/// Every Rust file below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| match path.is_dir() {
            true => sources(&path),
            false => vec![path],
        })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}

/// The code of the files below a folder by their modules.
fn codes_below(source: &Path) -> BTreeMap<Names, String> {
    let mut codes = BTreeMap::new();
    for path in sources(source) {
        let within = path.strip_prefix(source).unwrap().with_extension("");
        let mut module: Names = within.iter().map(|name| name.to_str().unwrap().to_owned()).collect();
        module.pop_if(|last| matches!(last.as_str(), "mod" | "lib" | "main"));
        if !module.iter().any(|name| name == "tests") {
            codes.insert(module, code(&std::fs::read_to_string(&path).unwrap()));
        }
    }
    codes
}

/// The imports of a file, whether they are exported again, and the rest of the code.
fn imports(code: &str) -> (Vec<(String, bool)>, String) {
    let (mut all, mut rest, mut last) = (Vec::new(), String::new(), 0);
    for (at, _) in code.match_indices("use ") {
        let before = code[..at].rsplit('\n').next().unwrap_or("").trim();
        let is_import =
            before.is_empty() || before == "pub" || (before.starts_with("pub(") && before.ends_with(')'));
        if at < last || !is_import {
            continue;
        }
        let end = at + code[at..].find(';').unwrap();
        all.extend(
            paths(&code[at + 4..end].replace('\n', " ")).into_iter().map(|path| (path, !before.is_empty())),
        );
        rest.push_str(&code[last..at]);
        last = end + 1;
    }
    rest.push_str(&code[last..]);
    (all, rest)
}

/// Paths in code, from where they begin.
fn named(code: &str) -> Vec<String> {
    let starts = code.match_indices("::").filter_map(|(at, _)| {
        let start = code[..at].rfind(|c| !is_of_name(c)).map_or(0, |before| before + 1);
        // `pub(in a::b)` uses nothing.
        let is_path = start < at && ![":", "(in "].iter().any(|before| code[..start].ends_with(before));
        is_path.then_some(start)
    });
    let whole = |start: usize| {
        let path: String = code[start..].chars().take_while(|c| is_of_name(*c) || *c == ':').collect();
        path.trim_end_matches(':').to_owned()
    };
    starts.map(whole).collect()
}

/// A path from the crate's root; `None` of one that leads out of the crate.
fn absolute(path: &str, module: &Names, codes: &BTreeMap<Names, String>) -> Option<Names> {
    let names: Names = path.split("::").map(str::to_owned).collect();
    let above = names.iter().take_while(|name| *name == "super").count();
    match names[0].as_str() {
        "crate" => Some(names[1..].to_vec()),
        "self" => Some([module, &names[1..]].concat()),
        "super" => Some([&module[..module.len() - above], &names[above..]].concat()),
        first => {
            let inside = [module.as_slice(), &[first.to_owned()]].concat();
            codes.contains_key(&inside).then(|| [module.as_slice(), &names].concat())
        }
    }
}

#[test]
fn files_of_a_crate_use_each_other_one_way() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for folder in std::fs::read_dir(crates).unwrap() {
        let source = folder.unwrap().path().join("src");
        let mut left = Files::of(&source).used();
        // What uses nothing that is left can be read; what remains uses each other.
        loop {
            let known: BTreeSet<Names> = left.keys().cloned().collect();
            let before = left.len();
            left.retain(|_, used| used.iter().any(|other| known.contains(other)));
            if left.len() == before {
                break;
            }
        }
        let circle: Vec<String> = left.keys().map(|module| module.join("/")).collect();
        assert!(
            circle.is_empty(),
            "{}: these files, or files that they use, use each other: {circle:?}",
            source.display()
        );
    }
}

#[test]
fn imports_are_read_as_the_compiler_reads_them() {
    assert_eq!(
        paths("crate::{a, b::{self, c as d}, e}"),
        ["crate::a", "crate::b::self", "crate::b::c", "crate::e"]
    );
    assert_eq!(paths("super::x"), ["super::x"]);
    let (imports, rest) = imports("use a::b;\npub(crate) use c::{d,\n  e};\nfn f() { g::h() }");
    let expected = [("a::b", false), ("c::d", true), ("c::e", true)].map(|(path, is)| (path.to_owned(), is));
    assert_eq!(imports, expected);
    assert_eq!(named(&rest), ["g::h"]);
    let tests = "fn a() {}\n// crate::b\n#[cfg(test)]\n#[allow(x)]\nmod tests {\n use super::*; }\nfn c() {}";
    assert_eq!(code(tests), "fn a() {}\n\nfn c() {}");
}

#[test]
fn a_crate_whose_sources_hold_tests_runs_them() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut untested = 0;
    for entry in std::fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path();
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        if !manifest.lines().any(|line| line.trim() == "test = false") {
            continue;
        }
        untested += 1;
        for source in sources(&folder.join("src")) {
            let text = std::fs::read_to_string(&source).unwrap();
            assert!(!text.contains("#[test]"), "{} holds tests that never run", source.display());
        }
    }
    assert!(untested > 0, "manifests say it otherwise now");
}
