/* edgewalk/edgewalk.h - all layers of the library at once. */
#ifndef EW_EDGEWALK_H
#define EW_EDGEWALK_H

#include "config.h"
#include "display.h"
#include "draw2d.h"
#include "error.h"
#include "fixed.h"
#include "geometry.h"
#include "light.h"
#include "panel.h"
#include "picture.h"
#include "raster.h"
#include "scene.h"

#define EW_VERSION "0.1.0"

#endif
