//! The session as plain functions over memory, which a web worker calls.
//!
//! The caller writes a request to memory from [`room`]. [`answer`] takes the request and returns the address of the
//! answer: the status and the length as numbers of 32 bits, then the bytes. [`free`] takes the answer back.

#![allow(unsafe_code, reason = "memory is shared with the caller, who is no Rust")]

use crate::session::Session;
use std::cell::RefCell;

unsafe extern "C" {
    // Entity types register themselves in constructors. Nothing else calls them here.
    fn __wasm_call_ctors();
}

thread_local! {
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// The length of the head of an answer, in bytes.
const HEAD: usize = 8;

/// Registers the entity types. The caller calls it once, before all else.
#[unsafe(no_mangle)]
pub extern "C" fn start() {
    // SAFETY: it takes nothing, and is called once.
    unsafe { __wasm_call_ctors() };
    SESSION.with_borrow_mut(|session| *session = Some(Session::new()));
}

/// Returns memory of this many bytes, which belongs to the caller.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    Box::into_raw(vec![0_u8; length].into_boxed_slice()).cast()
}

/// Takes memory back.
///
/// # Safety
/// The memory comes from [`room`] or from [`answer`], with this length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn free(at: *mut u8, length: usize) {
    // SAFETY: the caller's promise.
    drop(unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(at, length)) });
}

/// Answers a request, and takes its memory back. The first bytes are the path, and the rest is the body.
///
/// # Safety
/// The request comes from [`room`], with this length, and is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn answer(at: *mut u8, path: usize, length: usize) -> *mut u8 {
    // SAFETY: the caller's promise.
    let request = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(at, length)) };
    let (path, body) = request.split_at(path.min(length));
    let path = str::from_utf8(path).unwrap_or_default();
    let answer =
        SESSION.with_borrow_mut(|session| session.get_or_insert_with(Session::new).answer(path, body));
    let mut out = Vec::with_capacity(HEAD + answer.bytes.len());
    out.extend(u32::from(answer.status).to_le_bytes());
    out.extend((answer.bytes.len() as u32).to_le_bytes());
    out.extend(answer.bytes);
    Box::into_raw(out.into_boxed_slice()).cast()
}
