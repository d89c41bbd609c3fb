//! Opens the page in the user's browser.

use std::env;
use std::io::{self, Write};
use tempfile::{Builder, TempPath};

/// Opens an address in the browser, through a file that is removed when it is dropped.
///
/// Every user of a machine can read the command lines of all processes, so that of the browser must not contain the
/// address. The file's permissions keep other users from reading it.
pub fn open(url: &str) -> io::Result<TempPath> {
    // A browser in a sandbox does not see the system's folder for temporary files.
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
