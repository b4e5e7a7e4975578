//! A fit of the directional albedo as source text. The Rust function that the library tests is the master; the other languages are
//! made of its text, so that they cannot drift from it.

use crate::dfg_source::Language;
use lumisphere_bsdf::albedo_fit::{AlbedoFit, FitResult};
use std::fmt::Write;

/// The function in a language, with a comment that says what it returns and how well. It needs nothing beside it.
pub fn fit_source(fit: &AlbedoFit, language: Language) -> String {
    let comments = [fit.returns.to_owned(), format!("{}; absolute error at most {:.1e}.", fit.domain, fit.error)];
    let mut text: String = comments.iter().map(|line| format!("// {line}\n")).collect();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{}", opening(fit, language));
    let body = fit.body();
    let (lines, result) = body.rsplit_once(';').unwrap_or(("", &body));
    for line in lines.split(';').map(str::trim).filter(|line| !line.is_empty()) {
        let (name, value) = line.trim_start_matches("let ").split_once('=').unwrap_or((line, ""));
        let _ = writeln!(text, "    {} {} = {};", declaration(language), name.trim(), expression(value, language));
    }
    let _ = writeln!(text, "    {}\n}}", returned(&expression(result, language), fit, language));
    text
}

fn opening(fit: &AlbedoFit, language: Language) -> String {
    let name = fit.function;
    let arguments =
        |form: &dyn Fn(&str) -> String| fit.arguments.iter().map(|a| form(a)).collect::<Vec<_>>().join(", ");
    let typed = arguments(&|a| format!("float {a}"));
    match (language, fit.result) {
        (Language::Glsl, FitResult::Pair) => format!("vec2 {name}({typed}) {{"),
        (Language::Hlsl, FitResult::Pair) => format!("float2 {name}({typed}) {{"),
        (Language::Glsl | Language::Hlsl, FitResult::One) => format!("float {name}({typed}) {{"),
        (Language::Wgsl, FitResult::Pair) => format!("fn {name}({}) -> vec2f {{", arguments(&|a| format!("{a}: f32"))),
        (Language::Wgsl, FitResult::One) => format!("fn {name}({}) -> f32 {{", arguments(&|a| format!("{a}: f32"))),
        (Language::C, FitResult::Pair) => format!("static inline void {name}({typed}, float result[2]) {{"),
        (Language::C, FitResult::One) => format!("static inline float {name}({typed}) {{"),
        (Language::Rust, FitResult::Pair) => {
            format!("pub fn {name}({}) -> [f32; 2] {{", arguments(&|a| format!("{a}: f32")))
        }
        (Language::Rust, FitResult::One) => format!("pub fn {name}({}) -> f32 {{", arguments(&|a| format!("{a}: f32"))),
    }
}

fn declaration(language: Language) -> &'static str {
    match language {
        Language::Glsl | Language::Hlsl => "float",
        Language::C => "const float",
        Language::Wgsl | Language::Rust => "let",
    }
}

/// Sums, products and calls are the same everywhere; the name of the root is not, nor the type of C's numbers.
fn expression(text: &str, language: Language) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let text = words.join(" ").replace("( ", "(").replace(" )", ")");
    match language {
        Language::Glsl | Language::Hlsl | Language::Wgsl => text,
        Language::Rust => text.replace("sqrt(", "f32::sqrt("),
        Language::C => float_suffixes(&text.replace("sqrt(", "sqrtf(")),
    }
}

/// `1.5` becomes `1.5f`.
fn float_suffixes(text: &str) -> String {
    let mut out = String::new();
    let mut number = false;
    for c in text.chars() {
        let digit = c.is_ascii_digit() || c == '.';
        let after_word = out.chars().last().is_some_and(|last| last.is_alphanumeric() || last == '_');
        if number && !digit {
            out.push('f');
        }
        number = digit && (number || !after_word);
        out.push(c);
    }
    if number { out + "f" } else { out }
}

fn returned(value: &str, fit: &AlbedoFit, language: Language) -> String {
    let inner = value.trim().trim_start_matches('[').trim_end_matches(']').trim();
    match (fit.result, language) {
        (FitResult::One, Language::Rust) | (FitResult::Pair, Language::Rust) => value.trim().to_owned(),
        (FitResult::One, _) => format!("return {};", value.trim()),
        (FitResult::Pair, Language::Glsl) => format!("return vec2({inner});"),
        (FitResult::Pair, Language::Hlsl) => format!("return float2({inner});"),
        (FitResult::Pair, Language::Wgsl) => format!("return vec2f({inner});"),
        (FitResult::Pair, Language::C) => {
            let (first, second) = inner.split_once(", ").unwrap_or((inner, ""));
            format!("result[0] = {first};\n    result[1] = {second};")
        }
    }
}
