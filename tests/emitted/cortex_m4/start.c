/* What a Cortex-M4 needs before main: a vector table, the floating-point unit switched on, memory set to zero. */
#include <stdlib.h>

extern unsigned char zero_begin, zero_end, stack_top;
extern void initialise_monitor_handles(void);
extern int main(void);

void reset(void);
void stop(void);

/* What the C library runs before and after main where there are constructors. */
void _init(void);
void _fini(void);

void _init(void)
{
}

void _fini(void)
{
}

void stop(void)
{
    abort();
}

void reset(void)
{
    *(volatile unsigned *)0xE000ED88U |= 0xFU << 20; /* access to the floating-point unit */
    for (unsigned char *byte = &zero_begin; byte < &zero_end; ++byte) {
        *byte = 0U;
    }
    initialise_monitor_handles();
    exit(main());
}

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    &stack_top, (const void *)reset, (const void *)stop, (const void *)stop,
    (const void *)stop, (const void *)stop, (const void *)stop,
};
