//! Which module may import which.
//!
//! Imports are read from the lexer's tokens: text in comments is no path, line breaks and nested groups hide
//! none, and neither does the body of a macro, which a syntax tree would leave unparsed.

use crate::texts_below;
use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use std::path::Path;

enum May {
    /// These and no other.
    Import(&'static [&'static str]),
    /// Every module of the rows above its own.
    ImportAllAbove,
    ImportAnything,
}

/// Modules in rows, each allowed to import only from rows above it (`error`, which wraps them all, apart).
const TABLE: &[(&[&str], May)] = &[
    (&["math", "vulkan", "shaders"], May::Import(&[])),
    (&["io", "yarn", "bsdf", "gpu_types"], May::Import(&["math"])),
    (&["knit"], May::Import(&["math", "io", "yarn"])),
    (&["scene"], May::Import(&["math", "io", "yarn", "knit", "bsdf"])),
    (&["motion"], May::Import(&["math", "io", "yarn", "scene"])),
    (&["precompute"], May::Import(&["math", "io", "yarn", "bsdf"])),
    (&["reference"], May::Import(&["math", "io", "yarn", "bsdf", "scene"])),
    (&["metrics"], May::Import(&["math", "io"])),
    (&["graph"], May::Import(&["vulkan", "shaders"])),
    (&["passes"], May::Import(&["math", "vulkan", "shaders", "gpu_types", "graph", "scene", "precompute"])),
    (
        &["frame"],
        May::Import(&[
            "math",
            "io",
            "yarn",
            "motion",
            "gpu_types",
            "passes",
            "graph",
            "vulkan",
            "shaders",
            "scene",
            "precompute",
        ]),
    ),
    (&["error"], May::ImportAnything),
    (&["probe", "bench"], May::ImportAllAbove),
    (&["stress"], May::ImportAllAbove),
    (
        &["viewer"],
        May::Import(&[
            "math",
            "io",
            "yarn",
            "frame",
            "scene",
            "motion",
            "precompute",
            "shaders",
            "vulkan",
            "metrics",
            "error",
        ]),
    ),
    (&["cli"], May::ImportAllAbove),
];

fn row_of(module: &str) -> Option<usize> {
    TABLE.iter().position(|(names, _)| names.contains(&module))
}

fn may_import(from: &str, to: &str) -> bool {
    let (Some(from_row), Some(to_row)) = (row_of(from), row_of(to)) else { return false };
    match &TABLE[from_row].1 {
        May::Import(listed) => listed.contains(&to),
        May::ImportAllAbove => to_row < from_row,
        May::ImportAnything => true,
    }
}

/// The module that a file below `src/` holds: `io/bcc.rs` is `io::bcc`, `io/mod.rs` is `io`; roots are empty.
fn module_of(file_in_src: &Path) -> Vec<String> {
    let mut module: Vec<String> = file_in_src
        .with_extension("")
        .components()
        .map(|part| part.as_os_str().to_string_lossy().into_owned())
        .collect();
    if module.last().is_some_and(|last| last == "mod") || module == ["lib"] || module == ["main"] {
        module.pop();
    }
    module
}

/// Every import of `source` that the table forbids, as `file:line: what is wrong`.
fn forbidden_imports(file_in_src: &str, source: &str) -> Vec<String> {
    let module = module_of(Path::new(file_in_src));
    let Some(from) = module.first().cloned() else { return Vec::new() };
    let mut scan =
        Scan { file: format!("src/{file_in_src}"), from, module, literal_line: None, found: Vec::new() };
    if row_of(&scan.from).is_none() {
        scan.reject(
            1,
            &format!("module `{}` is not in the table of tests/architecture/imports.rs", scan.from),
        );
    }
    match source.parse::<TokenStream>() {
        Ok(tokens) => scan.walk(tokens),
        Err(error) => scan.reject(error.span().start().line, "not Rust"),
    }
    scan.found
}

struct Scan {
    file: String,
    /// The top-level module of the file.
    from: String,
    /// The module that the walk is in, inline modules included.
    module: Vec<String>,
    /// Set while the walk is inside a string literal, whose tokens count lines from its own start.
    literal_line: Option<usize>,
    found: Vec<String>,
}

impl Scan {
    fn reject(&mut self, line: usize, why: &str) {
        let line = self.literal_line.unwrap_or(line);
        self.found.push(format!("{}:{line}: {why}", self.file));
    }

    fn walk(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while at < tokens.len() {
            at += self.step(&tokens[at..]);
        }
    }

    /// Handles what begins at the first token and returns how many tokens it took.
    fn step(&mut self, tokens: &[TokenTree]) -> usize {
        let line = tokens[0].span().start().line;
        match (tokens, name(tokens, 0).as_deref()) {
            ([_, _, TokenTree::Group(body), ..], Some("mod")) if body.delimiter() == Delimiter::Brace => {
                self.module.extend(name(tokens, 1));
                self.walk(body.stream());
                self.module.pop();
                return 3;
            }
            (_, Some("crate" | "worsted" | "super" | "self"))
                if is_path_separator(tokens, 1) || name(tokens, 1).as_deref() == Some("as") =>
            {
                return self.follow(self.module.clone(), tokens);
            }
            // `extern crate self as other_name`.
            (_, Some("crate")) if name(tokens, 1).as_deref() == Some("self") => self.check(&[], &tokens[0]),
            ([TokenTree::Group(group), ..], _) => self.walk(group.stream()),
            ([TokenTree::Literal(literal), ..], _) => self.walk_literal(&literal.to_string(), line),
            ([TokenTree::Punct(hash), TokenTree::Group(attribute), ..], _) if hash.as_char() == '#' => {
                let inside: Vec<TokenTree> = attribute.stream().into_iter().collect();
                let elsewhere = inside.last().is_some_and(|value| value.to_string().contains(['/', '\\']));
                if name(&inside, 0).as_deref() == Some("path") && elsewhere {
                    self.reject(line, "`#[path]` takes a module from another folder");
                }
            }
            _ => {}
        }
        1
    }

    /// Attributes such as serde's name functions in strings: `default = "crate::math::one"`.
    fn walk_literal(&mut self, literal: &str, line: usize) {
        let text = literal.trim_matches('"');
        if !["crate::", "super::", "self::"].iter().any(|root| text.starts_with(root)) {
            return;
        }
        if let Ok(tokens) = text.parse::<TokenStream>() {
            let outer = self.literal_line.replace(line);
            self.walk(tokens);
            self.literal_line = outer;
        }
    }

    /// Follows one path or `use` tree that starts in `module`, checks what every branch ends in, and returns how
    /// many tokens it took.
    fn follow(&mut self, mut module: Vec<String>, tokens: &[TokenTree]) -> usize {
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            match (name(tokens, at).as_deref(), token) {
                (Some("crate" | "worsted"), _) if at == 0 => module.clear(),
                (Some("super"), _) => drop(module.pop()),
                (Some("self"), _) => {}
                (Some(segment), _) => module.push(segment.to_owned()),
                (None, TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                    let branches: Vec<TokenTree> = group.stream().into_iter().collect();
                    for branch in
                        branches.split(|token| is_punct(token, ',')).filter(|branch| !branch.is_empty())
                    {
                        self.follow(module.clone(), branch);
                    }
                    return at + 1;
                }
                // A glob, or the generic arguments of `path::<T>`.
                (None, _) => {
                    self.check(&module, token);
                    return at;
                }
            }
            if !is_path_separator(tokens, at + 1) {
                self.check(&module, token);
                return at + 1;
            }
            at += 3;
        }
        at
    }

    fn check(&mut self, imported: &[String], place: &TokenTree) {
        let line = place.span().start().line;
        match imported.first() {
            None => self.reject(line, "imports the crate root, which hides what is imported"),
            Some(to) if *to == self.from || may_import(&self.from, to) => {}
            Some(to) => self.reject(line, &format!("`{}` may not import `{to}`", self.from)),
        }
    }
}

fn name(tokens: &[TokenTree], at: usize) -> Option<String> {
    match tokens.get(at) {
        Some(TokenTree::Ident(ident)) => Some(ident.to_string().trim_start_matches("r#").to_owned()),
        _ => None,
    }
}

fn is_punct(token: &TokenTree, character: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == character)
}

fn is_path_separator(tokens: &[TokenTree], at: usize) -> bool {
    matches!(tokens.get(at..at + 2), Some([TokenTree::Punct(first), second])
        if first.as_char() == ':' && first.spacing() == Spacing::Joint && is_punct(second, ':'))
}

#[test]
fn modules_import_what_the_table_allows() {
    let sources: Vec<_> = texts_below("src").into_iter().filter(|(path, _)| path.ends_with(".rs")).collect();
    assert!(sources.iter().any(|(path, _)| path == "src/lib.rs"), "the sources were not found");
    let found: Vec<String> =
        sources.iter().flat_map(|(path, source)| forbidden_imports(&path["src/".len()..], source)).collect();
    assert!(found.is_empty(), "forbidden imports:\n{}", found.join("\n"));
}

#[test]
fn the_table_only_points_up() {
    for (row, (modules, may)) in TABLE.iter().enumerate() {
        let May::Import(listed) = may else { continue };
        for to in *listed {
            let above = row_of(to).is_some_and(|to_row| to_row < row);
            assert!(above, "{modules:?}: `{to}` is not in a row above");
        }
    }
}

/// File, source, line and what the message must name.
const FORBIDDEN: &[(&str, &str, usize, &str)] = &[
    ("io/bcc.rs", "use crate::yarn::Ply;", 1, "`yarn`"),
    ("io/bcc.rs", "use crate::{math::Rng, yarn};", 1, "`yarn`"),
    (
        "io/bcc.rs",
        "use crate::{\n    math::{self, Rng},\n    passes::{\n        fibers,\n    },\n};",
        4,
        "`passes`",
    ),
    ("io/usd/mod.rs", "use super::super::passes::fibers;", 1, "`passes`"),
    ("io/bcc.rs", "use super::{error, super::{math, knit}};", 1, "`knit`"),
    ("frame.rs", "use super::viewer;", 1, "`viewer`"),
    ("math/rng.rs", "fn f() -> f64 {\n    crate::io::curves::length(1.0)\n}", 2, "`io`"),
    ("math/rng.rs", "fn f() { g::<crate::io::CurveSet>() }", 1, "`io`"),
    ("metrics/error.rs", "fn f() {\n    assert_eq!(1, crate::scene::one());\n}", 2, "`scene`"),
    ("yarn/ply.rs", "macro_rules! m { () => { $crate::knit::rib() } }", 1, "`knit`"),
    ("yarn/ply.rs", "mod tests {\n    use super::super::super::knit;\n}", 2, "`knit`"),
    (
        "scene/mod.rs",
        "struct S {\n    #[serde(default = \"crate::frame::size\")]\n    size: u32,\n}",
        2,
        "`frame`",
    ),
    ("reference/mod.rs", "use worsted::precompute;", 1, "`precompute`"),
    ("reference/mod.rs", "impl crate::vulkan::Device {}", 1, "`vulkan`"),
    ("probe/mod.rs", "use crate::stress;", 1, "`stress`"),
    ("vulkan/mod.rs", "use crate::shaders;", 1, "`shaders`"),
    ("scene/mod.rs", "use crate::error::Error;", 1, "`error`"),
    ("io/bcc.rs", "use crate::CurveSet;", 1, "`CurveSet`"),
    ("io/bcc.rs", "use crate::*;", 1, "crate root"),
    ("frame.rs", "use super::*;", 1, "crate root"),
    ("io/bcc.rs", "use crate as all;", 1, "crate root"),
    ("io/bcc.rs", "use crate::{self as all};", 1, "crate root"),
    ("io/bcc.rs", "extern crate self as all;", 1, "crate root"),
    ("io/bcc.rs", "extern crate worsted as all;", 1, "crate root"),
    ("frame.rs", "use super as all;", 1, "crate root"),
    ("io/mod.rs", "#[path = \"../yarn/ply.rs\"]\nmod ply;", 1, "`#[path]`"),
    ("surface/mod.rs", "", 1, "`surface` is not in the table"),
    ("io/bcc.rs", "fn f() {\n    )\n}", 2, "not Rust"),
];

#[test]
fn forbidden_imports_are_found() {
    for (file, source, line, why) in FORBIDDEN {
        let found = forbidden_imports(file, source);
        let place = format!("src/{file}:{line}: ");
        assert!(found.len() == 1, "{file}: {source}\ngave {found:?}");
        assert!(found[0].starts_with(&place) && found[0].contains(*why), "{file}: {source}\ngave {found:?}");
    }
}

#[test]
fn every_forbidden_branch_is_reported() {
    let found =
        forbidden_imports("math/mod.rs", "use crate::{io, math, yarn::{ply, fiber}};\nuse crate::knit;");
    assert_eq!(found.len(), 4, "{found:?}");
}

const ALLOWED: &[(&str, &str)] = &[
    ("io/bcc.rs", "use crate::{io::error::FileError, math::{curve::*, Rng as R}};\nuse std::io;"),
    (
        "io/bcc.rs",
        "//! Not [`crate::yarn`].\n// use crate::yarn;\n/* crate::yarn */ const S: &str = \"a crate::yarn\";",
    ),
    ("io/bcc.rs", "pub(crate) fn f() {}\npub(in crate::io) fn g() {}\nmod tests { use super::*; }"),
    ("io/bcc.rs", "fn f(&self) { self.g(crate::math::h::<f64>(0.5)); other::yarn::x(); }"),
    ("io/usd/mod.rs", "use super::{error, super::math};\nuse self::parse::parse;"),
    ("bench/mod.rs", "use crate::{error::Error, frame, passes, shaders, vulkan};"),
    ("cli/mod.rs", "use crate::{bench, error::Error, math, stress, viewer};"),
    ("error.rs", "use crate::{cli, io::error::FileError, viewer};"),
    ("io/picture.rs", "#[cfg(test)]\n#[path = \"picture_tests.rs\"]\nmod tests;"),
    ("lib.rs", "pub mod io;\npub use crate::io::curves::CurveSet;"),
    ("main.rs", "use worsted::cli;"),
];

#[test]
fn allowed_imports_pass() {
    for (file, source) in ALLOWED {
        let found = forbidden_imports(file, source);
        assert!(found.is_empty(), "{file}: {source}\ngave {found:?}");
    }
}
