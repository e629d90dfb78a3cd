//! Lists of lights for tiles, in memory from an allocator that never takes any back.

use core::alloc::{GlobalAlloc, Layout};
use core::ptr::null_mut;
use core::sync::atomic::{AtomicUsize, Ordering};

use stochastic_light_culling::{Culler, Error, LightBatch, LightLists, TileDepths};

use crate::pipeline;

const CAPACITY: usize = 1 << 20;

/// Memory that is handed out from the beginning to the end.
#[repr(align(64))]
struct Arena(core::cell::UnsafeCell<[u8; CAPACITY]>, AtomicUsize);

// Sound: no byte of it is handed out twice.
unsafe impl Sync for Arena {}

// Sound: what is given out begins at a multiple of the alignment, as the arena does of up to 64, lies
// within it, and is no one else's.
unsafe impl GlobalAlloc for Arena {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // Whole multiples of the greatest alignment, so that each piece begins at one.
        let size = layout.size().next_multiple_of(64);
        let start = self.1.fetch_add(size, Ordering::Relaxed);
        if layout.align() > 64 || start + size > CAPACITY {
            return null_mut();
        }
        // Within the arena, as has just been asked.
        unsafe { self.0.get().cast::<u8>().add(start) }
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[global_allocator]
static ARENA: Arena = Arena(
    core::cell::UnsafeCell::new([0; CAPACITY]),
    AtomicUsize::new(0),
);

/// As many tiles list the one light as the scalar test finds touched.
pub fn lists_as_it_must() -> bool {
    let listed = listed();
    listed.is_ok() && listed == pipeline::touched()
}

fn listed() -> Result<usize, Error> {
    let (camera, grid, depths) = (pipeline::camera()?, pipeline::grid()?, pipeline::depths()?);
    let mut tiles = TileDepths::new(&grid, &camera, 1)?;
    for tile in grid.tiles() {
        tiles.set(tile, [depths]);
    }
    let mut batch = LightBatch::new();
    batch.extend(pipeline::stretch(0)?.map(|stretch| (7, stretch)));
    let mut lists = LightLists::new();
    Culler::new().cull(&batch, &tiles, &mut lists)?;
    let all_are_it = lists.lights().iter().all(|number| *number == 7);
    Ok(if all_are_it { lists.len() } else { 0 })
}
