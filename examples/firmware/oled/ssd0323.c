/* Lines of the LM3S6965 evaluation board: SSI0 has its clock at PA2, its frame signal at PA3
 * and its data at PA5; PC7 tells the panel data from commands; PD0 high deselects the SD card
 * on the same wires. Sources: LM3S6965 data sheet (registers), SSD0323 data sheet (commands). */
#include "ssd0323.h"

/* Which pin of port C is the panel's D/C line, and where the panel's window starts, in bytes. */
#ifndef PANEL_DC_PIN
#define PANEL_DC_PIN 7
#endif
#ifndef PANEL_FIRST_COLUMN
#define PANEL_FIRST_COLUMN 0
#endif

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
enum { SYSTEM = 0x400FE000, PORT_A = 0x40004000, PORT_C = 0x40006000, PORT_D = 0x40007000, SSI = 0x40008000 };
enum { RCGC1 = 0x104, RCGC2 = 0x108 };                             /* SYSTEM: clocks of peripherals */
enum { DIRECTION = 0x400, ALTERNATE = 0x420, DIGITAL = 0x51C };    /* ports                         */
enum { CR0 = 0x00, CR1 = 0x04, DATA = 0x08, STATUS = 0x0C, PRESCALE = 0x10 }; /* SSI                */
enum { STATUS_ROOM = 2, STATUS_RECEIVED = 4, STATUS_BUSY = 16 };

static void pin_output(uint32_t port, uint32_t pin)
{
    REGISTER(port + DIRECTION) |= 1u << pin;
    REGISTER(port + DIGITAL) |= 1u << pin;
}

/* The address is the mask of the pins that a write reaches. */
static void pin_set(uint32_t port, uint32_t pin, int high)
{
    REGISTER(port + (4u << pin)) = high ? 1u << pin : 0u;
}

static void drain(void)
{
    while (REGISTER(SSI + STATUS) & STATUS_RECEIVED) (void)REGISTER(SSI + DATA);
}

static void send(const uint8_t *bytes, uint32_t n, int is_data)
{
    pin_set(PORT_C, PANEL_DC_PIN, is_data);
    while (n--) {
        while (!(REGISTER(SSI + STATUS) & STATUS_ROOM)) {
        }
        REGISTER(SSI + DATA) = *bytes++;
        drain();
    }
    while (REGISTER(SSI + STATUS) & STATUS_BUSY) { /* D/C may not change before the last bit is out */
    }
    drain();
}

void panel_init(void)
{
    static const uint8_t commands[] = {
        0xAE,                         /* off while it is set up                             */
        0x81, 0x2C, 0x86,             /* contrast, full range of current                    */
        0xA0, 0x50,                   /* remap: rows interleaved and from the other side    */
        0xA1, 0, 0xA2, 0, 0xA8, 63,   /* start line, offset, 64 rows                        */
        0xA4,                         /* show the memory                                    */
        0xB1, 0x11, 0xB3, 0x91, 0xAD, 0x02, 0xBC, 0x10, 0xBE, 0x10, 0xBF, 0x0E, /* timing, voltages */
        0xAF                          /* on                                                 */
    };
    REGISTER(SYSTEM + RCGC1) |= 0x10; /* SSI0          */
    REGISTER(SYSTEM + RCGC2) |= 0x0D; /* ports A, C, D */
    (void)REGISTER(SYSTEM + RCGC2);   /* the clock needs a few cycles */
    REGISTER(PORT_A + ALTERNATE) |= 0x2C;
    REGISTER(PORT_A + DIGITAL) |= 0x2C;
    pin_output(PORT_C, PANEL_DC_PIN);
    pin_output(PORT_D, 0);
    pin_set(PORT_D, 0, 1);
    REGISTER(SSI + CR1) = 0;
    REGISTER(SSI + PRESCALE) = 2;
    REGISTER(SSI + CR0) = 0x3C7;      /* clock / 4, idle high, second edge, 8 bits */
    REGISTER(SSI + CR1) = 2;          /* on, as master */
    send(commands, sizeof commands, 0);
}

void panel_show(const uint8_t pixels[PANEL_ROW_BYTES * PANEL_HEIGHT])
{
    static const uint8_t commands[] = {
        0x15, PANEL_FIRST_COLUMN, PANEL_ROW_BYTES - 1, /* columns */
        0x75, 0, PANEL_HEIGHT - 1                      /* rows    */
    };
    send(commands, sizeof commands, 0);
    send(pixels, PANEL_ROW_BYTES * PANEL_HEIGHT, 1);
}
