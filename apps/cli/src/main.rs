//! The `lumisphere` command: bakes, inspects and verifies image-based lighting, renders and compares pictures.

mod args;
mod bake_command;
mod bake_environment;
mod brdf;
mod builtin_source;
mod choices;
mod compare;
mod convert_command;
mod convert_content;
mod convert_harmonics;
mod convert_output;
mod dfg_command;
mod environment_input;
mod environments;
mod files;
mod formats_command;
mod formats_report;
mod inspect_command;
mod inspect_report;
mod inspect_scene;
mod model_input;
mod output;
mod preview;
mod progress;
mod record;
mod render;
mod resume;
mod scene_input;
mod shading;
mod summary;
mod target_plan;
mod targets_command;
mod timings;
mod usage;
mod values;
mod verify_command;
mod verify_files;
mod verify_foreign;
mod verify_format;
mod verify_measure;
mod verify_orientation;
mod verify_own;
mod verify_report;

use anyhow::{Context, Result, anyhow};
use args::{Cli, Command};
use clap::{CommandFactory, Parser};
use std::process::ExitCode;

/// `verify` found an error over the contract, or `compare` one over a limit.
const OVER_CONTRACT: u8 = 1;
/// Anything that went wrong, as with clap's own errors.
const FAILED: u8 = 2;

fn main() -> ExitCode {
    match run(Cli::parse().command) {
        Ok(code) => code,
        Err(error) => {
            output::error(&error);
            ExitCode::from(FAILED)
        }
    }
}

fn run(command: Command) -> Result<ExitCode> {
    match command {
        Command::Bake(args) => {
            set_threads(args.common.threads)?;
            bake_command::run(&args)?;
        }
        Command::Targets { json } => targets_command::run(json)?,
        Command::Convert(args) => {
            set_threads(args.common.threads)?;
            convert_command::run(&args)?;
        }
        Command::Dfg(args) => {
            set_threads(args.common.threads)?;
            dfg_command::run(&args)?;
        }
        Command::Formats(args) => {
            set_threads(args.common.threads)?;
            formats_command::run(&args)?;
        }
        Command::Inspect(args) => {
            set_threads(args.common.threads)?;
            inspect_command::run(&args)?;
        }
        Command::Verify(args) => {
            set_threads(args.common.threads)?;
            if !verify_command::run(&args)? {
                return Ok(ExitCode::from(OVER_CONTRACT));
            }
        }
        Command::Compare(args) => {
            set_threads(args.common.threads)?;
            if !compare::run(&args)? {
                return Ok(ExitCode::from(OVER_CONTRACT));
            }
        }
        Command::Render(args) => {
            set_threads(args.common.threads)?;
            return render::run(&args);
        }
        Command::Brdf(args) => brdf::run(&args)?,
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "lumisphere", &mut text);
            output::bytes(&text)?;
        }
        Command::Man { command } => output::bytes(&manual_page(command.as_deref())?)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn set_threads(threads: Option<u16>) -> Result<()> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global().context("--threads")
}

fn manual_page(command: Option<&str>) -> Result<Vec<u8>> {
    let mut root = Cli::command();
    root.build();
    let page = match command {
        None => root,
        Some(name) => root.find_subcommand(name).cloned().ok_or_else(|| anyhow!("{name}: no such command"))?,
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text)?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_of_the_command_line_is_sound() {
        Cli::command().debug_assert();
    }
}
