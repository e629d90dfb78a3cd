//! No bits, however strange, make a constructor panic, or make NaN of what it has accepted.
//!
//! A fuzz target too: `cargo bolero test --test any_bits any_bytes` runs it under a fuzzer.

mod bits;
mod construct;
mod culling;
mod families;
mod fields;
mod findings;
mod other_lobes;
mod probe;

use bits::Bits;
use bolero::{ValueGenerator, check, produce};

/// More bytes than any case reads.
fn bytes() -> impl ValueGenerator<Output = Vec<u8>> {
    produce::<Vec<u8>>().with().len(512_usize)
}

#[test]
fn any_bytes() {
    check!()
        .with_generator(bytes())
        .with_iterations(200_000)
        .for_each(|bytes| construct::everything(&mut Bits(bytes)));
}

#[test]
fn no_light_of_any_bytes_is_lost() {
    check!()
        .with_generator(bytes())
        .with_iterations(2_000_000)
        .for_each(|bytes| construct::light_in_domain(&mut Bits(bytes)));
}
