//! BMP files with four masks of bits after the header of 40 bytes. Later headers hold the same masks at the same place.

/// The lengths of the header of the file, of the first header of an image, and of the first that holds four masks.
const FILE: usize = 14;
const FIRST: u32 = 40;
const WITH_MASKS: u32 = 108;

/// The compressions "masks for red, green, blue and alpha", of the first header alone, and "masks".
const FOUR_MASKS: u32 = 6;
const MASKS: u32 = 3;

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

/// Tells whether a file with this beginning has four masks after the first header.
pub fn has_four_masks(beginning: &[u8]) -> bool {
    beginning.starts_with(b"BM")
        && number(beginning, FILE) == Some(FIRST)
        && number(beginning, FILE + 16) == Some(FOUR_MASKS)
}

/// Returns the same image with a later header, or `None` if the file ends before its masks do.
pub fn with_later_header(bytes: &[u8]) -> Option<Vec<u8>> {
    let masks_end = FILE + FIRST as usize + 16;
    let (head, rest) = bytes.split_at_checked(masks_end)?;
    let more = WITH_MASKS - FIRST - 16;
    let mut all = head.to_vec();
    let mut set = |at: usize, number: u32| all[at..at + 4].copy_from_slice(&number.to_le_bytes());
    set(10, number(bytes, 10)?.checked_add(more)?);
    set(FILE, WITH_MASKS);
    set(FILE + 16, MASKS);
    all.resize(masks_end + more as usize, 0);
    all.extend_from_slice(rest);
    Some(all)
}
