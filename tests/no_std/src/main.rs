//! The whole pipeline in a program without the standard library, and without the feature `cull` without an
//! allocator: if the crate or one of its dependencies needed either, this would not link.
//!
//! It is a program for the host, started by its C library, so that it can run as well: its status is 0 if
//! light touches the tiles that it must and no other.

#![no_std]
#![no_main]

#[cfg(feature = "cull")]
mod cull;
mod pipeline;

use core::ffi::c_int;

// What calls `main`, and the functions that copy memory, which compiled code calls unasked.
#[link(name = "c")]
unsafe extern "C" {
    fn abort() -> !;
}

/// A second one, of the standard library, would not link.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // Safe: C's `abort` asks for nothing.
    unsafe { abort() }
}

/// The core library, compiled for programs that unwind, asks for this symbol, which the standard library
/// would define. With `panic = "abort"` nothing calls it.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

/// Sound as the only `main` of the program, with the signature that C has for it.
#[unsafe(no_mangle)]
extern "C" fn main() -> c_int {
    #[cfg(feature = "cull")]
    let passed = pipeline::touches_as_it_must() && cull::lists_as_it_must();
    #[cfg(not(feature = "cull"))]
    let passed = pipeline::touches_as_it_must();
    c_int::from(!passed)
}
