//! The folder that everything goes to.

use std::fs;
use std::path::Path;

/// Makes sure that files can be written to `folder`.
pub fn make_folder(folder: &Path) -> Result<(), String> {
    let probe = folder.join(format!(".probe.{}.part", std::process::id()));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&probe, []))
        .and_then(|()| fs::remove_file(&probe))
        .map_err(|error| format!("cannot write to {}: {error}", folder.display()))
}
