//! Joins the codes of streams of `fdeflate`, which have one block each, at any bit.

/// The number of bits before the codes of a stream: the header of zlib, and that of the block with its Huffman code.
const BEFORE: usize = 429;

/// The number of bits of the code that ends a block.
const END: usize = 12;

/// The number of bits that are copied at a time: with up to seven others before or after them, they fit into 64 bits.
const TOGETHER: usize = 48;

/// Appends the codes of another stream to those of a stream. Neither has a checksum.
pub(super) fn append(stream: &mut Vec<u8>, next: &[u8]) {
    let (end, next_end) = (len(stream) - END, len(next));
    let mut count = end % 8;
    stream.truncate(end.div_ceil(8));
    // The bits of the last byte that is not full.
    let mut bits = if count > 0 { stream.pop().map_or(0, u64::from) & ((1 << count) - 1) } else { 0 };
    stream.reserve(next.len());
    for at in (BEFORE..next_end).step_by(TOGETHER) {
        let taken = TOGETHER.min(next_end - at);
        let word = match next[at / 8..].first_chunk() {
            Some(word) => u64::from_le_bytes(*word),
            None => next[at / 8..].iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte)),
        };
        bits |= (word >> (at % 8) & ((1 << taken) - 1)) << count;
        count += taken;
        let whole = count / 8;
        stream.extend_from_slice(&bits.to_le_bytes()[..whole]);
        (bits, count) = (bits >> (8 * whole), count % 8);
    }
    if count > 0 {
        stream.push(bits as u8);
    }
}

/// Returns the number of bits of a stream: the code that ends the block ends with a 1, after which the last byte is
/// filled up with zeros.
fn len(stream: &[u8]) -> usize {
    8 * stream.len() - stream.last().map_or(0, |last| last.leading_zeros() as usize)
}
