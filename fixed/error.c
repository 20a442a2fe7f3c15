#include "edgewalk/error.h"

const char *ew_error_text(int code)
{
    switch (code) {
    case EW_OK: return "no error";
    case EW_ERR_ARGUMENT: return "an argument is out of its range";
    case EW_ERR_RANGE: return "a number does not fit its fixed-point format";
    case EW_ERR_MAGIC: return "not an edgewalk file";
    case EW_ERR_VERSION: return "a version of the format that this program does not know";
    case EW_ERR_TRUNCATED: return "cut short";
    case EW_ERR_CHECKSUM: return "wrong checksum, the data was changed";
    case EW_ERR_CORRUPT: return "an offset, index or count points outside";
    case EW_ERR_ROOM: return "not enough memory given";
    case EW_ERR_UNSUPPORTED: return "a feature that this build leaves out";
    default: return "unknown error";
    }
}
