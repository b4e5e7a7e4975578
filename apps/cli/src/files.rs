//! Files that appear complete and all at once, or not at all.
//!
//! Each file is written under a temporary name in its own folder and renamed when all of them are there. An interrupt
//! or an error before that removes the temporary files, and the folders that were made for them.
//!
//! A program that is killed outright cannot clean up, so its temporary files stay. What has its final name is whole even
//! then: while files are being renamed there is no record of them.

use crate::record;
use anyhow::{Context, Result, anyhow, bail};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile};

/// Exit code after an interrupt: 128 and the number of SIGINT, as shells report it.
pub(crate) const INTERRUPTED: u8 = 130;

/// Whether the program has been asked to come to an end; by default nobody asks.
#[derive(Clone, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// It has.
    pub(crate) fn came(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// Tells it; true if it was told before.
    fn raise(&self) -> bool {
        self.0.swap(true, Ordering::SeqCst)
    }
}

/// What has been written and not yet renamed.
#[derive(Default)]
struct Staged {
    /// Folders made for the files, outermost first.
    folders: Vec<PathBuf>,
    files: Vec<(NamedTempFile, PathBuf)>,
}

impl Staged {
    /// Removes everything, as far as that succeeds.
    fn discard(&mut self) {
        for (file, _) in self.files.drain(..) {
            // There is nobody left to tell of a file that cannot be removed.
            let _ = file.close();
        }
        for folder in self.folders.drain(..).rev() {
            // Fails, rightly, if somebody else has put something into it.
            let _ = std::fs::remove_dir(folder);
        }
    }
}

/// The place where files wait until all are complete.
#[derive(Clone, Default)]
pub(crate) struct Stage {
    staged: Arc<Mutex<Staged>>,
}

impl Stage {
    /// An empty stage that is cleared when the program is interrupted or told to end.
    pub(crate) fn cleared_on_interrupt() -> Result<Self> {
        let stage = Self::default();
        let shared = stage.clone();
        ctrlc::set_handler(move || shared.end()).context("cannot watch for interrupts")?;
        Ok(stage)
    }

    /// The same, but the first interrupt is only told, for work that can be kept; it is for the caller to end then. `asked` is called
    /// from another thread.
    pub(crate) fn cleared_on_second_interrupt(asked: impl Fn() + Send + 'static) -> Result<(Self, Interrupt)> {
        let (stage, interrupt) = (Self::default(), Interrupt::default());
        let (shared, told) = (stage.clone(), interrupt.clone());
        ctrlc::set_handler(move || if told.raise() { shared.end() } else { asked() })
            .context("cannot watch for interrupts")?;
        Ok((stage, interrupt))
    }

    /// Clears the stage and ends the program.
    fn end(&self) {
        // Holding the lock keeps the main thread from making or renaming files until the end.
        let mut staged = self.lock();
        staged.discard();
        std::process::exit(INTERRUPTED.into());
    }

    /// Writes files under temporary names in `folder`, which is made if it is not there.
    pub(crate) fn write(&self, folder: &Path, files: &[(&str, &[u8])]) -> Result<()> {
        self.make_folder(folder).with_context(|| folder.display().to_string())?;
        for (name, bytes) in files {
            let path = folder.join(name);
            self.write_one(folder, &path, bytes).with_context(|| path.display().to_string())?;
        }
        Ok(())
    }

    /// Gives every file its name, in the order of writing. Older records that will be replaced are removed first: at no
    /// moment does a record lie beside files that it does not describe.
    pub(crate) fn publish(&self) -> Result<()> {
        let mut staged = self.lock();
        reach_disk(&staged.files)?;
        for (_, path) in staged.files.iter().filter(|(_, path)| path.ends_with(record::FILE)) {
            remove_if_there(path).with_context(|| path.display().to_string())?;
        }
        while !staged.files.is_empty() {
            let (file, path) = staged.files.remove(0);
            file.persist(&path).map_err(|error| error.error).with_context(|| path.display().to_string())?;
        }
        staged.folders.clear();
        Ok(())
    }

    /// Gives up what is not published.
    pub(crate) fn discard(&self) {
        self.lock().discard();
    }

    fn make_folder(&self, folder: &Path) -> Result<()> {
        if folder.is_dir() {
            return Ok(());
        }
        let mut staged = self.lock();
        let missing: Vec<&Path> = folder.ancestors().take_while(|a| !a.as_os_str().is_empty() && !a.exists()).collect();
        for ancestor in missing.into_iter().rev() {
            std::fs::create_dir(ancestor)?;
            staged.folders.push(ancestor.to_owned());
        }
        if folder.is_dir() { Ok(()) } else { Err(anyhow!("found a file, expected a folder")) }
    }

    fn write_one(&self, folder: &Path, path: &Path, bytes: &[u8]) -> Result<()> {
        if path.is_dir() {
            return Err(anyhow!("found a folder, expected a file or nothing"));
        }
        let mut handle = {
            let mut staged = self.lock();
            let file = temporary(folder)?;
            let handle = file.as_file().try_clone()?;
            staged.files.push((file, path.to_owned()));
            handle
        };
        handle.write_all(bytes)?;
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, Staged> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Stage {
    /// The last but one owner is the program's own; the last is the interrupt handler, which lives on.
    fn drop(&mut self) {
        self.lock().discard();
    }
}

/// Waits until the files are on the disk: otherwise a power cut may leave an empty file under a final name, and a full
/// network disk may say so only when nobody listens any more. Several wait at once: a journal then takes them together.
fn reach_disk(files: &[(NamedTempFile, PathBuf)]) -> Result<()> {
    let wait =
        |(file, path): &(NamedTempFile, PathBuf)| file.as_file().sync_all().with_context(|| path.display().to_string());
    for some in files.chunks(16) {
        std::thread::scope(|scope| {
            let waiting: Vec<_> = some.iter().map(|one| scope.spawn(move || wait(one))).collect();
            waiting
                .into_iter()
                .try_for_each(|w| w.join().unwrap_or_else(|_| Err(anyhow!("waiting for the disk failed"))))
        })?;
    }
    Ok(())
}

fn remove_if_there(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

fn temporary(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".lumisphere-").suffix(".part");
    #[cfg(unix)]
    {
        // Temporary files are private by default; these become ordinary ones, under the user's umask.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Writes one file as a whole or not at all.
pub(crate) fn write_one(path: &Path, bytes: &[u8]) -> Result<()> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name =
        name.with_context(|| format!("{}: expected the name of a file, of Unicode characters", path.display()))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let stage = Stage::cleared_on_interrupt()?;
    stage.write(folder, &[(name, bytes)])?;
    stage.publish()
}

/// Refuses a path that does not end in .png.
pub(crate) fn expect_png(path: &Path) -> Result<()> {
    match path.extension().and_then(|e| e.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(()),
        found => {
            bail!("{}: found the extension {:?}, expected .png", path.display(), found.unwrap_or_default())
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_left_of_what_is_not_published() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("a/b");
        let stage = Stage::default();
        stage.write(&folder, &[("x", b"1"), ("y", b"2")]).unwrap();
        assert!(!folder.join("x").exists());
        drop(stage);
        assert!(!root.path().join("a").exists());
    }

    #[test]
    fn published_files_replace_older_ones_and_leave_no_other() {
        let root = tempfile::tempdir().unwrap();
        std::fs::write(root.path().join("x"), b"old").unwrap();
        let stage = Stage::default();
        stage.write(root.path(), &[("x", b"new")]).unwrap();
        assert_eq!(std::fs::read(root.path().join("x")).unwrap(), b"old");
        stage.publish().unwrap();
        drop(stage);
        assert_eq!(std::fs::read(root.path().join("x")).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(root.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_older_record_is_gone_before_any_other_file_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        let record = root.path().join(record::FILE);
        std::fs::write(&record, b"old").unwrap();
        let stage = Stage::default();
        stage.write(root.path(), &[("first", b"new"), (record::FILE, b"new")]).unwrap();
        // The first rename fails, as if the program ended there.
        std::fs::create_dir(root.path().join("first")).unwrap();
        assert!(stage.publish().is_err());
        drop(stage);
        assert!(!record.exists());
    }
}
