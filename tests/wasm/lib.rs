//! Lists every entity type, and renders a scene on the calling thread.

use std::ffi::{CString, c_char};
use tabray_lang::Registry;

#[path = "../../src/lang/examples/scene.rs"]
mod scene;

unsafe extern "C" {
    // Entity types register themselves in constructors, which nothing else calls here.
    fn __wasm_call_ctors();
}

/// Returns a text that ends with a NUL byte. To be called once.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const c_char {
    // SAFETY: it takes nothing, and is called once.
    unsafe { __wasm_call_ctors() };
    tabray_plugins::link();
    let names = match Registry::get() {
        Ok(registry) => registry.iter().map(|entity| entity.name).collect::<Vec<_>>().join(" "),
        Err(faults) => faults.to_string(),
    };
    let picture = scene::answer().unwrap_or_else(|error| error.to_string());
    CString::new(format!("{names}\n{picture}")).unwrap_or_default().into_raw()
}
