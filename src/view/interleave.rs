use super::PixelRectangle;
use crate::base::Error;

/// Interleaved sampling: every w-th pixel in x and y belongs to one of w² *subregions*, small images of
/// the whole view, each lit by 1/w² of the lights [Segovia et al. 2006].
///
/// Converts indices of pixels and lights, and stores no pixels. If w does not divide the image, the sizes of
/// the subregions differ by one pixel. Subregions are numbered from 0, row by row of their first pixels.
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

/// Upper limit of w. Its square is a `u32`.
const MAX_WIDTH: u32 = 0xffff;

impl Interleave {
    /// Creates the interleaving of an image of `image_size` = \[width, height\] pixels with w = `width`.
    /// With w = 1 the only subregion is the image.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if a side of the image is zero, or `width` is zero, greater than a side of the image,
    /// or greater than 65535.
    pub fn new(image_size: [u32; 2], width: u32) -> Result<Self, Error> {
        if image_size.contains(&0) {
            return Err(Error::Size {
                quantity: "image size",
                value: image_size,
                valid: "at least 1×1",
            });
        }
        if width == 0 || image_size.iter().any(|n| *n < width) || width > MAX_WIDTH {
            return Err(Error::Size {
                quantity: "interleaving width",
                value: [width; 2],
                valid: "at least 1×1, at most the size of the image, and at most 65535×65535",
            });
        }
        Ok(Self { image_size, width })
    }

    /// The width and height of the image in pixels.
    #[must_use]
    pub fn image_size(&self) -> [u32; 2] {
        self.image_size
    }

    /// w, the distance in pixels between neighbours of a subregion.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// The number of subregions, w².
    #[must_use]
    pub fn subregions(&self) -> u32 {
        self.width * self.width
    }

    /// w² as a factor for the radiance in a subregion, which makes up for the lights that it leaves out.
    #[must_use]
    pub fn weight(&self) -> f32 {
        self.subregions() as f32
    }

    /// The width and height of `subregion` in pixels. A `subregion` of w² or more counts as one modulo w².
    #[must_use]
    pub fn subregion_size(&self, subregion: u32) -> [u32; 2] {
        let phase = self.phase(subregion);
        [0, 1].map(|i| (self.image_size[i] - phase[i]).div_ceil(self.width))
    }

    /// Converts a `pixel` of the image to its subregion and its pixel there.
    #[inline]
    #[must_use]
    pub fn split_pixel(&self, pixel: [u32; 2]) -> (u32, [u32; 2]) {
        let [x, y] = pixel.map(|n| n % self.width);
        (y * self.width + x, pixel.map(|n| n / self.width))
    }

    /// Converts the pixel `local` of `subregion` to a pixel of the image: the inverse of
    /// [`split_pixel`](Self::split_pixel). For a pixel outside its subregion the result is outside the image;
    /// it saturates at `u32::MAX`.
    #[inline]
    #[must_use]
    pub fn join_pixel(&self, subregion: u32, local: [u32; 2]) -> [u32; 2] {
        let phase = self.phase(subregion);
        [0, 1].map(|i| local[i].saturating_mul(self.width).saturating_add(phase[i]))
    }

    /// The smallest rectangle of the image that holds the pixels `local` of `subregion`: what a tile of a
    /// subregion covers.
    #[must_use]
    pub fn join_pixels(&self, subregion: u32, local: PixelRectangle) -> PixelRectangle {
        PixelRectangle {
            min: self.join_pixel(subregion, local.min),
            max: self
                .join_pixel(subregion, local.max.map(|n| n.saturating_sub(1)))
                .map(|n| n.saturating_add(1)),
        }
    }

    /// Converts the index of a `light` to the subregion that it lights and its index among the lights of
    /// that subregion.
    ///
    /// Neighbouring lights go to different subregions. Shuffle lights first if their order has a pattern,
    /// such as a grid.
    #[inline]
    #[must_use]
    pub fn split_light(&self, light: u32) -> (u32, u32) {
        (light % self.subregions(), light / self.subregions())
    }

    /// Converts the index `local` of a light in `subregion` to its index among all lights: the inverse of
    /// [`split_light`](Self::split_light). Saturates at `u32::MAX`.
    #[inline]
    #[must_use]
    pub fn join_light(&self, subregion: u32, local: u32) -> u32 {
        local
            .saturating_mul(self.subregions())
            .saturating_add(subregion)
    }

    /// The number of lights in `subregion`, if there are `lights` in all.
    #[must_use]
    pub fn lights_in(&self, subregion: u32, lights: u32) -> u32 {
        lights.saturating_sub(subregion).div_ceil(self.subregions())
    }

    /// The position of the pixels of `subregion` in their w×w blocks.
    fn phase(&self, subregion: u32) -> [u32; 2] {
        [
            subregion % self.width,
            (subregion / self.width) % self.width,
        ]
    }
}
