//! Completions of files and folders that a scene can name.

use super::proposal::{Completion, CompletionContext, CompletionKind, plain};
use std::path::Path;
use tabray_core::files;

/// The maximum number of proposed files of a folder.
const MAX_FILES: usize = 1000;

impl CompletionContext<'_> {
    /// Returns the files and folders in the folder of the path before the position.
    pub(super) fn files(&self) -> Vec<Completion> {
        let text = self.view.text.as_str();
        let start = text[..self.at].rfind(|c: char| c.is_whitespace() || c == '"' || c == '\'' || c == '{');
        let after = |end: usize| end + text[end..].chars().next().map_or(1, char::len_utf8);
        let typed = &text[start.map_or(0, after)..self.at];
        let (folder, prefix) =
            typed.rsplit_once('/').map_or(("", typed), |(folder, prefix)| (folder, prefix));
        let place = self.at - prefix.len()..self.at;
        let folder =
            if typed.starts_with('/') { Path::new("/").join(folder) } else { self.folder.join(folder) };
        let entries = files::read_dir(&folder).into_iter().flatten().filter_map(Result::ok).take(MAX_FILES);
        let mut names: Vec<_> = entries
            .filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path().is_dir())))
            .filter(|(name, _)| !name.starts_with('.'))
            .collect();
        names.sort_unstable();
        let proposal = |(name, is_folder): (String, bool)| {
            let label = if is_folder { format!("{name}/") } else { name };
            plain(&label, if is_folder { CompletionKind::Folder } else { CompletionKind::File }, &place)
        };
        names.into_iter().map(proposal).collect()
    }
}
