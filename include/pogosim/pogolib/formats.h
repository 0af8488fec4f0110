/// @file
/// PRIu64 and its relatives of <inttypes.h>, which is included here. Where `long` has 64 bits, that header makes them
/// "lu" and the like, which printf() of the robots takes for 32 bits. Here they are "ju": the same type for the
/// compiler, and 64 bits for printf() of the robots and of the C library.
#ifndef POGOSIM_POGOLIB_FORMATS_H
#define POGOSIM_POGOLIB_FORMATS_H

#ifdef __cplusplus
extern "C++" {
#include <cinttypes>
}
#endif
#include <inttypes.h>

#if defined(__linux__) && defined(__LP64__)

#undef PRId64
#define PRId64 "jd"
#undef PRIi64
#define PRIi64 "ji"
#undef PRIo64
#define PRIo64 "jo"
#undef PRIx64
#define PRIx64 "jx"
#undef PRIu64
#define PRIu64 "ju"
#undef PRIX64
#define PRIX64 "jX"

#undef PRIdLEAST64
#define PRIdLEAST64 "jd"
#undef PRIiLEAST64
#define PRIiLEAST64 "ji"
#undef PRIoLEAST64
#define PRIoLEAST64 "jo"
#undef PRIxLEAST64
#define PRIxLEAST64 "jx"
#undef PRIuLEAST64
#define PRIuLEAST64 "ju"
#undef PRIXLEAST64
#define PRIXLEAST64 "jX"

#undef PRIdFAST16
#define PRIdFAST16 "jd"
#undef PRIiFAST16
#define PRIiFAST16 "ji"
#undef PRIoFAST16
#define PRIoFAST16 "jo"
#undef PRIxFAST16
#define PRIxFAST16 "jx"
#undef PRIuFAST16
#define PRIuFAST16 "ju"
#undef PRIXFAST16
#define PRIXFAST16 "jX"

#undef PRIdFAST32
#define PRIdFAST32 "jd"
#undef PRIiFAST32
#define PRIiFAST32 "ji"
#undef PRIoFAST32
#define PRIoFAST32 "jo"
#undef PRIxFAST32
#define PRIxFAST32 "jx"
#undef PRIuFAST32
#define PRIuFAST32 "ju"
#undef PRIXFAST32
#define PRIXFAST32 "jX"

#undef PRIdFAST64
#define PRIdFAST64 "jd"
#undef PRIiFAST64
#define PRIiFAST64 "ji"
#undef PRIoFAST64
#define PRIoFAST64 "jo"
#undef PRIxFAST64
#define PRIxFAST64 "jx"
#undef PRIuFAST64
#define PRIuFAST64 "ju"
#undef PRIXFAST64
#define PRIXFAST64 "jX"

#undef PRIdMAX
#define PRIdMAX "jd"
#undef PRIiMAX
#define PRIiMAX "ji"
#undef PRIoMAX
#define PRIoMAX "jo"
#undef PRIxMAX
#define PRIxMAX "jx"
#undef PRIuMAX
#define PRIuMAX "ju"
#undef PRIXMAX
#define PRIXMAX "jX"

#undef PRIdPTR
#define PRIdPTR "jd"
#undef PRIiPTR
#define PRIiPTR "ji"
#undef PRIoPTR
#define PRIoPTR "jo"
#undef PRIxPTR
#define PRIxPTR "jx"
#undef PRIuPTR
#define PRIuPTR "ju"
#undef PRIXPTR
#define PRIXPTR "jX"

#endif

#endif
