//! `USE.md`: the few lines that load the files of a target in its engine.

use lumisphere::bake::ChainSettings;
use lumisphere::target::Target;
use std::fmt::Write;

/// Name of the file.
pub(crate) const FILE: &str = "USE.md";

/// The whole text.
pub(crate) fn text(target: &Target, chain: &ChainSettings, has_chain: bool) -> String {
    let mut text = format!("# Light for {}\n\nThe engine needs: {}.\n\n", target.engine, target.needs);
    text.push_str(target.usage);
    if has_chain {
        text.push_str("\n## Levels\n\n| lod | perceptual roughness |\n|---|---|\n");
        for (lod, p) in chain.roughness().iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "| {lod} | {:.4} |", p.value());
        }
    }
    text
}
