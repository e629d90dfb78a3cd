//! Runs what is built beside Bevy, and what is built beside the newest glam. Their numbers are the same.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (beside_bevy, beside_glam) = (beside_bevy::touched_tiles()?, beside_glam::touched_tiles()?);
    assert_eq!(beside_bevy, beside_glam);
    println!("{beside_bevy} tiles, with either glam");
    Ok(())
}
