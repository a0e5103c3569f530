//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that is written under another name and takes its own when it is whole. Dropped before, it leaves nothing.
#[derive(Debug)]
pub(super) struct AtomicFile {
    file: File,
    path: PathBuf,
    temporary: PathBuf,
    committed: bool,
}

impl AtomicFile {
    /// Opens the temporary file, beside the place of the final one.
    ///
    /// # Errors
    /// Those of the file system, with the name in the message.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let mut name = OsString::from(path.file_name().unwrap_or_default());
        // Two programs that write the same file must not share the temporary one.
        name.push(format!(".{}.part", std::process::id()));
        let temporary = path.with_file_name(name);
        let file = File::create(&temporary).map_err(|error| named(path, &error))?;
        Ok(Self { file, path: path.to_owned(), temporary, committed: false })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// Those of the file system, with the name in the message.
    pub(super) fn commit(mut self) -> io::Result<()> {
        self.file.flush()?;
        fs::rename(&self.temporary, &self.path).map_err(|error| named(&self.path, &error))?;
        self.committed = true;
        Ok(())
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes).map_err(|error| named(&self.path, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.committed {
            // Nothing can be done about a file that will not go.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Writes a whole file.
///
/// # Errors
/// Those of the file system, with the name in the message; then there is no new file.
pub fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(content)?;
    file.commit()
}

fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}
