//! The page in the browser of whoever runs the program.

use std::env;
use std::io::{self, Write};
use tempfile::{Builder, TempPath};

/// Opens an address in the browser, by way of a file that goes when it is dropped.
///
/// Every user of a machine can read the command lines of all processes, so the browser's must not hold the address. The
/// file's permissions are such that no other user can read it.
pub fn open(url: &str) -> io::Result<TempPath> {
    // A browser that is kept in a sandbox sees no folder for temporary files.
    let folder = env::home_dir().filter(|home| home.is_dir()).unwrap_or_else(env::temp_dir);
    let mut file = Builder::new().prefix("tabray-").suffix(".html").tempfile_in(folder)?;
    write!(
        file,
        "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta http-equiv=\"refresh\" content=\"0; url={url}\">\n<title>tabray</title>\n<a href=\"{url}\">tabray</a>\n"
    )?;
    let path = file.into_temp_path();
    open::that(&path)?;
    Ok(path)
}
