// Tables of FITS files (ASCII and binary ones) and of VOTable documents (IVOA 1.1 to 1.5). In: a file, or a
// document's text. Out: their tables in order, as rows whose numbers are text again. Columns of anything but
// single numbers and texts have no name.
#pragma once

#include "core/progress.h"
#include "core/text.h"

namespace astrosplat {

struct FileTable {
    std::string title;  // for messages: "HDU 1 stars"
    std::unique_ptr<RowTable> rows;
};

/// TNULL, TSCAL and TZERO are followed; what is undefined has an empty field. Rows throw InputError where the
/// file ends before they do. Throws InputError, Cancelled.
std::vector<FileTable> fits_tables(const fs::path& file, const Progress& progress = {});

/// Of "J2000", "2000.0" and empty texts: places are those of ICRS.
bool is_equinox_2000(std::string_view equinox);

/// Whether a text begins as a VOTable does.
bool is_votable(std::string_view text);

/// Of TABLEDATA, BINARY and BINARY2, in base64 and packed by gzip or not; nulls have an empty field. Rows
/// throw InputError for data that are damaged, or not in the document. `name` begins messages. Throws
/// InputError for what is no XML.
std::vector<FileTable> votables(std::string text, const std::string& name, const Progress& progress = {});

}  // namespace astrosplat
