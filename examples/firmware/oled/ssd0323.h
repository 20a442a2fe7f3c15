/* A 128x64 OLED of 16 greys with the SSD0323 controller, on the LM3S6965's serial port SSI0. */
#ifndef SSD0323_H
#define SSD0323_H

#include <stdint.h>

enum { PANEL_WIDTH = 128, PANEL_HEIGHT = 64, PANEL_ROW_BYTES = PANEL_WIDTH / 2 };

/* Sets the port up and switches the panel on. */
void panel_init(void);

/* Shows a picture: two pixels to a byte, the left one in the high four bits. */
void panel_show(const uint8_t pixels[PANEL_ROW_BYTES * PANEL_HEIGHT]);

#endif
