/* edgewalk/error.h - the few codes that a public function may return. */
#ifndef EW_ERROR_H
#define EW_ERROR_H

#ifdef __cplusplus
extern "C" {
#endif

/* Zero or more is success; a function that counts returns its count. */
typedef enum ew_error {
    EW_OK = 0,
    EW_ERR_ARGUMENT = -1,  /* a parameter is outside its documented range         */
    EW_ERR_RANGE = -2,     /* a number does not fit its fixed-point format        */
    EW_ERR_MAGIC = -3,     /* the data is not what its first bytes should say     */
    EW_ERR_VERSION = -4,   /* a format version that this reader does not know     */
    EW_ERR_TRUNCATED = -5, /* the data ends before its own lengths say            */
    EW_ERR_CHECKSUM = -6,  /* the data was changed after it was written           */
    EW_ERR_CORRUPT = -7,   /* an offset, an index or a count points outside       */
    EW_ERR_ROOM = -8,      /* the caller's memory is smaller than the stated need */
    EW_ERR_UNSUPPORTED = -9 /* a feature that this build leaves out (config.h)    */
} ew_error;

/* A phrase for a code, lower case, without a full stop; never NULL. */
const char *ew_error_text(int code);

#ifdef __cplusplus
}
#endif

#endif
