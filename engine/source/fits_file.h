// Where CFITSIO opens files, each looked at first (source/fits.h). Include in .cpp files only.
#pragma once

#include <fitsio.h>

#include "core/progress.h"

namespace astrosplat {

/// Throws InputError "FILE: FITS DOING failed: REASON" where CFITSIO did not succeed.
void check_fits(const fs::path& file, std::string_view doing, int status);

/// Closes a file, and then gives up the memory that it was unpacked into.
struct FitsClose {
    struct Memory {
        std::string bytes;
        void* begin = nullptr;
        std::size_t size = 0;
    };
    std::unique_ptr<Memory> memory;

    void operator()(fitsfile* file) const;
};
using FitsFile = std::unique_ptr<fitsfile, FitsClose>;

/// By the plain name: brackets and blanks in it mean nothing special. What gzip or bzip2 packed is unpacked
/// in memory. Throws InputError, Cancelled.
FitsFile open_fits(const fs::path& file, const Progress& progress = {});

/// False where the current header has none.
bool read_fits_keyword(fitsfile* in, int type, const char* keyword, void* value);

/// Without blanks at its ends; empty where there is none.
std::string fits_text(fitsfile* in, const char* keyword);

/// HDUs of a file. Throws InputError.
int fits_hdu_count(const fs::path& file, fitsfile* in);

}  // namespace astrosplat
