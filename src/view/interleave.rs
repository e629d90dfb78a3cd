use super::PixelRectangle;
use crate::base::Error;

/// Interleaved sampling: every w-th pixel across and down makes up one of w² *subregions*, small
/// images of the whole view, each lit by 1/w² of the lights [Segovia et al. 2006].
///
/// A pure renumbering of pixels and lights. An image that w does not divide has subregions that
/// differ in size by one pixel.
///
/// ```
/// use stochastic_light_culling::Interleave;
///
/// let interleave = Interleave::new([1920, 1080], 8)?;
/// assert_eq!(interleave.subregions(), 64);
/// assert_eq!(interleave.subregion_size(0), [240, 135]);
/// assert_eq!(interleave.split_pixel([13, 8]), (5, [1, 1]));
/// assert_eq!(interleave.join_pixel(5, [1, 1]), [13, 8]);
/// assert_eq!((interleave.split_light(69), interleave.join_light(5, 1)), ((5, 1), 69));
/// assert_eq!((interleave.lights_in(5, 70), interleave.lights_in(6, 70)), (2, 1));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Interleave {
    image_size: [u32; 2],
    width: u32,
}

impl Interleave {
    /// Interleaving of an image of `image_size` = \[width, height\] with w = `width`; 1 leaves it whole.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if the image is empty, or `width` is zero or greater than either side of it.
    pub fn new(image_size: [u32; 2], width: u32) -> Result<Self, Error> {
        if image_size.contains(&0) {
            return Err(Error::Size {
                quantity: "image size",
                value: image_size,
                valid: "at least 1×1",
            });
        }
        if width == 0 || image_size.iter().any(|n| *n < width) || width > 0xffff {
            return Err(Error::Size {
                quantity: "interleaving width",
                value: [width; 2],
                valid: "at least 1×1 and at most the image",
            });
        }
        Ok(Self { image_size, width })
    }

    /// The width and height of the image in pixels.
    #[must_use]
    pub fn image_size(&self) -> [u32; 2] {
        self.image_size
    }

    /// w.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// w².
    #[must_use]
    pub fn subregions(&self) -> u32 {
        self.width * self.width
    }

    /// w², the factor that makes up for the lights a subregion leaves out.
    #[must_use]
    pub fn weight(&self) -> f32 {
        self.subregions() as f32
    }

    /// The width and height of `subregion` in pixels.
    #[must_use]
    pub fn subregion_size(&self, subregion: u32) -> [u32; 2] {
        let phase = self.phase(subregion);
        [0, 1].map(|i| (self.image_size[i] - phase[i]).div_ceil(self.width))
    }

    /// The subregion that `pixel` of the image is in, and which pixel of that it is.
    #[inline]
    #[must_use]
    pub fn split_pixel(&self, pixel: [u32; 2]) -> (u32, [u32; 2]) {
        let [x, y] = pixel.map(|n| n % self.width);
        (y * self.width + x, pixel.map(|n| n / self.width))
    }

    /// The pixel of the image that is `local` in `subregion`: the inverse of
    /// [`split_pixel`](Self::split_pixel). Outside the image, too, for a pixel that no subregion has.
    #[inline]
    #[must_use]
    pub fn join_pixel(&self, subregion: u32, local: [u32; 2]) -> [u32; 2] {
        let phase = self.phase(subregion);
        [0, 1].map(|i| local[i].saturating_mul(self.width).saturating_add(phase[i]))
    }

    /// The pixels of the image, edge to edge, that the pixels `local` of `subregion` lie within: what
    /// a tile of a subregion sees.
    #[must_use]
    pub fn join_pixels(&self, subregion: u32, local: PixelRectangle) -> PixelRectangle {
        PixelRectangle {
            min: self.join_pixel(subregion, local.min),
            max: self
                .join_pixel(subregion, local.max.map(|n| n.saturating_sub(1)))
                .map(|n| n.saturating_add(1)),
        }
    }

    /// The subregion that `light` lights, and its number among the lights of that.
    ///
    /// Neighbouring lights go to different subregions; where their order means something, as in a
    /// grid, shuffle them first.
    #[inline]
    #[must_use]
    pub fn split_light(&self, light: u32) -> (u32, u32) {
        (light % self.subregions(), light / self.subregions())
    }

    /// The light that is `local` in `subregion`: the inverse of [`split_light`](Self::split_light).
    /// Never past `u32::MAX`.
    #[inline]
    #[must_use]
    pub fn join_light(&self, subregion: u32, local: u32) -> u32 {
        local
            .saturating_mul(self.subregions())
            .saturating_add(subregion)
    }

    /// How many of `lights` light `subregion`.
    #[must_use]
    pub fn lights_in(&self, subregion: u32, lights: u32) -> u32 {
        lights.saturating_sub(subregion).div_ceil(self.subregions())
    }

    /// Where in its w×w block the pixels of `subregion` are.
    fn phase(&self, subregion: u32) -> [u32; 2] {
        [
            subregion % self.width,
            (subregion / self.width) % self.width,
        ]
    }
}
