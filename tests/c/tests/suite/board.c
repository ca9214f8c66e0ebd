/* What a program of the C library needs of a Cortex-M7 under QEMU: its start, and its arguments from the debugger. */
#include <stdint.h>
#include <stdlib.h>

extern void stack_top(void);
extern void initialise_monitor_handles(void);
extern int main(int argc, char **argv);
void reset(void);

static void semihosting(uint32_t operation, void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void fault(void)
{
    semihosting(0x18, (void *)0x20024);
    for (;;) {
    }
}

/* The C library calls it at the end; nothing has to be done. */
void _fini(void);
void _fini(void)
{
}

/* QEMU has put all data in its place. */
void reset(void)
{
    static char line[256], *arguments[8];
    struct {
        char *text;
        uint32_t size;
    } wanted = {line, sizeof line};
    int n = 0;
    /* Full access to the floating-point unit. */
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;
    __asm__ volatile("dsb\n isb" ::: "memory");
    initialise_monitor_handles();
    semihosting(0x15, &wanted);
    for (char *at = line; *at != 0 && n < 7;) {
        arguments[n++] = at;
        while (*at != 0 && *at != ' ')
            at++;
        while (*at == ' ')
            *at++ = 0;
    }
    exit(main(n, arguments));
}

__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    stack_top, reset, fault, fault, fault, fault, fault,
};
