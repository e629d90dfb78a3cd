// View: interleaved sampling, by integers alone. `Interleave` of the crate. Needs no other file.
//
// Every w-th pixel in x and y belongs to one of w² subregions, each lit by 1/w² of the lights
// [Segovia et al. 2006]. The radiance of a subregion is multiplied by w².

/// A pixel or a light, by its subregion and its place there.
struct SlcInterleavedPixel {
    subregion: u32,
    local: vec2u,
}

/// The subregion of a `pixel` of the image, and its pixel there, for w = `width`.
fn slc_split_pixel(width: u32, pixel: vec2u) -> SlcInterleavedPixel {
    let phase = pixel % vec2u(width);
    return SlcInterleavedPixel(phase.y * width + phase.x, pixel / vec2u(width));
}

/// The pixel of the image that is the pixel `local` of `subregion`.
fn slc_join_pixel(width: u32, subregion: u32, local: vec2u) -> vec2u {
    return local * width + vec2u(subregion % width, (subregion / width) % width);
}

/// The subregion that a `light` lights, and its index among the lights there, in that order.
fn slc_split_light(width: u32, light: u32) -> vec2u {
    let subregions = width * width;
    return vec2u(light % subregions, light / subregions);
}

/// The index among all lights of the light with the index `local` in `subregion`.
fn slc_join_light(width: u32, subregion: u32, local: u32) -> u32 {
    return local * (width * width) + subregion;
}

/// The number of lights in `subregion`, of `lights` in all.
fn slc_lights_in(width: u32, subregion: u32, lights: u32) -> u32 {
    if subregion >= lights {
        return 0u;
    }
    return (lights - subregion - 1u) / (width * width) + 1u;
}
