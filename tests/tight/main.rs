//! The bounds past the paper are as tight as they are said to be, and never above its spheroid: the
//! triaxial one within a few per cent of the least volume of its family and touched by the surface that it
//! is derived for, the tight one and that of a grain nearly the smallest ellipsoids there are.

mod extent;
mod grain;
mod isotropic;
