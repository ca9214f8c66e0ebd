/* What the example needs of a Cortex-M7 under QEMU: its start, and a console through the debugger. */
#include <stdint.h>

extern uint32_t data_begin[], data_end[], data_source[], bss_begin[], bss_end[], stack_top[];

int main(void);

static void semihosting(uint32_t operation, uint32_t argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register uint32_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void print(const char *text) {
    semihosting(0x04, (uint32_t)text);
}

static void leave(int is_success) {
    for (;;) {
        semihosting(0x18, is_success ? 0x20026 : 0x20024);
    }
}

static void fault(void) {
    print("hard fault\n");
    leave(0);
}

void reset(void) {
    for (uint32_t *from = data_source, *to = data_begin; to < data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = bss_begin; to < bss_end;) {
        *to++ = 0;
    }
    /* Full access to the floating-point unit. */
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;
    __asm__ volatile("dsb\n isb" ::: "memory");
    leave(main() == 0);
}

__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))stack_top, reset, fault, fault, fault, fault, fault,
};
