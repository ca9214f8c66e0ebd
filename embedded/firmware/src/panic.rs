//! The proof that nothing panics: the panic handler calls a function that does not exist, so firmware in which it can
//! be reached does not link.

use core::panic::PanicInfo;

unsafe extern "C" {
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: it is never called, as nothing that calls it links.
    unsafe { a_panic_can_be_reached() }
}

/// With the feature `fault`, an index that may be out of bounds: the proof must then fail.
#[inline(always)]
pub fn fault() {
    #[cfg(feature = "fault")]
    {
        let numbers = core::hint::black_box([1u8, 2, 3]);
        core::hint::black_box(numbers[core::hint::black_box(1)]);
    }
}
