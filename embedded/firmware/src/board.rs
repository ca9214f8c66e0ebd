//! What is QEMU's or the processor's: semihosting, the clock, the stack.

use core::arch::asm;
use core::ptr::{addr_of, read_volatile};
use cortex_m_rt::{ExceptionFrame, exception};

/// Asks the host, through the debugger's call.
fn semihosting(operation: u32, argument: usize) {
    // SAFETY: the operations used read at most the one byte or the string that the argument points to.
    unsafe {
        asm!("bkpt 0xab", inlateout("r0") operation => _, in("r1") argument, options(nostack));
    }
}

/// Writes to the console; what is written must end with a zero byte.
pub(crate) fn write<const N: usize>(text: &[u8; N]) {
    const WRITE0: u32 = 0x04;
    semihosting(WRITE0, text.as_ptr().addr());
}

/// Ends the program, with success or not.
pub fn exit(is_success: bool) -> ! {
    const REPORT: u32 = 0x18;
    const EXIT: usize = 0x20026;
    const ERROR: usize = 0x20024;
    loop {
        semihosting(REPORT, if is_success { EXIT } else { ERROR });
    }
}

/// An instruction that the processor does not have: most often double precision on one without.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    write(b"hard fault\n\0");
    exit(false)
}

/// The most that the stack has held so far, bytes; `cortex-m-rt` has painted it.
pub fn stack() -> u32 {
    unsafe extern "C" {
        static __sheap: u32;
        static _stack_start: u32;
    }
    const PAINT: u32 = 0xcccc_cccc;
    let (mut low, high) = (addr_of!(__sheap), addr_of!(_stack_start));
    // SAFETY: all that is between the end of the statics and the top of the stack is memory.
    while low < high && unsafe { read_volatile(low) } == PAINT {
        low = low.wrapping_add(1);
    }
    u32::try_from(high.addr() - low.addr()).unwrap_or(u32::MAX)
}
