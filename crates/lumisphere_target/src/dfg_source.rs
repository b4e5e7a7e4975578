//! The DFG table as source text, for programs that would rather compile it in than load it.

use lumisphere_bsdf::DfgTable;
use std::fmt::Write;

/// Languages of the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// GLSL 4.2 or ES 3.0: an array of `vec2`.
    Glsl,
    /// HLSL: a static array of `float2`.
    Hlsl,
    /// WGSL: a module-scope array of `vec2f`.
    Wgsl,
    /// C99: an array of `float[2]`.
    C,
    /// Rust: a static array of `[f32; 2]`.
    Rust,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Glsl, Self::Hlsl, Self::Wgsl, Self::C, Self::Rust];

    /// The usual extension.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
            Self::Wgsl => "wgsl",
            Self::C => "h",
            Self::Rust => "rs",
        }
    }

    /// What stands before the numbers.
    fn opening(self, size: usize) -> String {
        let count = size * size;
        match self {
            Self::Glsl => {
                format!("const int DFG_SIZE = {size};\nconst vec2 DFG[{count}] = vec2[{count}](\n")
            }
            Self::Hlsl => {
                format!("static const int DFG_SIZE = {size};\nstatic const float2 DFG[{count}] = {{\n")
            }
            Self::Wgsl => {
                format!("const DFG_SIZE: u32 = {size}u;\nconst DFG = array<vec2f, {count}>(\n")
            }
            Self::C => {
                format!("#define DFG_SIZE {size}\nstatic const float DFG[{count}][2] = {{\n")
            }
            Self::Rust => {
                format!("pub const DFG_SIZE: usize = {size};\npub static DFG: [[f32; 2]; {count}] = [\n")
            }
        }
    }

    /// One texel.
    fn value(self, [scale, bias]: [f32; 2]) -> String {
        match self {
            Self::Glsl => format!("vec2({scale:?}, {bias:?})"),
            Self::Hlsl => format!("float2({scale:?}, {bias:?})"),
            Self::Wgsl => format!("vec2f({scale:?}, {bias:?})"),
            Self::C => format!("{{{scale:?}f, {bias:?}f}}"),
            Self::Rust => format!("[{scale:?}, {bias:?}]"),
        }
    }

    /// What stands behind them.
    fn closing(self) -> &'static str {
        match self {
            Self::Glsl | Self::Wgsl => ");\n",
            Self::Hlsl | Self::C => "};\n",
            Self::Rust => "];\n",
        }
    }
}

/// The table as the source of an array, texel (x, y) at y·size + x, with a comment that says how to read it. Numbers are
/// the shortest that give back the same float.
pub fn dfg_source(table: &DfgTable, language: Language) -> String {
    let size = table.size();
    let mut text = String::from(
        "// Directional albedo of GGX: E = F0 * first + second.\n\
         // Texel (x, y) is DFG[y * DFG_SIZE + x], for n.v = (x + 0.5) / DFG_SIZE, perceptual roughness = (y + 0.5) / DFG_SIZE.\n",
    );
    text.push_str(&language.opening(size));
    let last = table.texels().len().saturating_sub(1);
    for (i, texel) in table.texels().iter().enumerate() {
        // GLSL and WGSL of this age take no comma after the last element.
        let comma = if i == last { "" } else { "," };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "    {}{comma}", language.value(*texel));
    }
    text.push_str(language.closing());
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_bsdf::Masking;

    /// The numbers of every language are the floats of the table, to the bit and in order.
    #[test]
    fn every_language_holds_the_table() {
        let table = DfgTable::compute(8, Masking::SmithGgxCorrelated).unwrap();
        for language in Language::ALL {
            let text = dfg_source(&table, language);
            let body =
                text.split_once("DFG[64]").or(text.split_once("array<vec2f, 64>(")).or(text.split_once("; 64] ="));
            let body = body.unwrap().1;
            let numbers: Vec<f32> = body
                .split(|c: char| !(c.is_ascii_digit() || ".e-".contains(c)))
                .filter(|word| word.contains('.') || word.contains("e-"))
                .filter_map(|word| word.parse().ok())
                .collect();
            assert_eq!(numbers, table.texels().as_flattened(), "{language:?}");
        }
    }
}
