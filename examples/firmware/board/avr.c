/* ATmega2560: the console is the first serial port. Start-up is the C library's; .init1 of it
 * is where the stack can be painted, before anything is on it. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "board.h"

enum { PAINT = 0xA5 };
extern uint8_t _end; /* of .bss: the stack comes down to it */

__attribute__((naked, used, section(".init1"))) void board_paint(void)
{
    __asm__ volatile("ldi r30, lo8(_end)\n ldi r31, hi8(_end)\n ldi r24, %0\n ldi r25, hi8(%1)\n"
                     "1: st Z+, r24\n cpi r30, lo8(%1)\n cpc r31, r25\n brlo 1b\n"
                     : : "i"(PAINT), "i"(RAMEND + 1));
}

uint32_t board_stack_used(void)
{
    const uint8_t *lowest = &_end;
    while ((uintptr_t)lowest <= RAMEND && *lowest == PAINT) lowest++;
    return (uint32_t)(RAMEND + 1u - (uintptr_t)lowest);
}

void board_print(const char *text)
{
    UCSR0B = _BV(TXEN0);
    for (; *text; text++) {
        while (!(UCSR0A & _BV(UDRE0))) {
        }
        UDR0 = (uint8_t)*text;
    }
}

void board_wait(void)
{
    UCSR0B |= _BV(RXEN0);
    while (!(UCSR0A & _BV(RXC0))) {
    }
    (void)UDR0;
}

void board_exit(int code)
{
    (void)code;
    cli();
    for (;;) sleep_mode();
}
