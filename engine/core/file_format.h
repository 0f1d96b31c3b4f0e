// The one table of the file formats that the program reads and writes. Readers, writers, import, `info`, the
// file dialogs and their messages all ask it, so that they cannot disagree.
#pragma once

#include <initializer_list>

#include "core/standard.h"

namespace astrosplat {

/// The kind of a file to its user. A look is a scene file too, until its content says otherwise.
enum class FileKind { unknown, scene, look, picture, mesh, splats };

/// The uses that the program has for files; several are or-ed.
enum class FileUse : unsigned {
    read = 0,            // as what their kind says: all that have one
    written = 1,         // as a frame, as splats or as a scene
    camera_read = 2,     // as camera.file
    camera_written = 4,  // for other programs
    exported = 8,        // a scene's splats, for other programs
    movie = 16,          // written as one
};

constexpr FileUse operator|(FileUse a, FileUse b) { return static_cast<FileUse>(unsigned(a) | unsigned(b)); }
constexpr bool includes(FileUse uses, FileUse use) { return (uses | use) == uses; }

/// The ending of a file's name, lower case, with the dot.
struct FileEnding {
    std::string_view text;
    FileUse uses = FileUse::read;  // of files of this ending alone

    constexpr FileEnding(const char* ending, FileUse own = FileUse::read) : text(ending), uses(own) {}
};

struct FileFormat {
    std::string_view id;    // pictures: the name of OpenImageIO's plug-in
    std::string_view name;  // for people
    FileKind kind = FileKind::unknown;
    std::vector<FileEnding> endings;      // the usual one first
    std::vector<std::string_view> magic;  // how such files begin, '?' for any byte; none: text of any kind
    FileUse uses = FileUse::read;         // of all its endings
    std::string_view converter = {};      // pictures that few OpenImageIO read: what makes others of them
};

std::span<const FileFormat> file_formats();

/// The format that a file's name promises, in capitals or not; nullptr for other names, and for endings that
/// do not have the use.
const FileFormat* format_by_name(const fs::path& file, FileUse use = FileUse::read);

/// The format of a file to be read: by its first bytes where a format has such, else by its name. nullptr for
/// other files.
const FileFormat* format_of_file(const fs::path& file);

/// FileKind::unknown where there is no format.
FileKind kind_of(const FileFormat* format);

/// The endings of all formats of these kinds, or of all kinds, that have a use.
std::vector<std::string> endings_of(std::initializer_list<FileKind> kinds, FileUse use = FileUse::read);
std::vector<std::string> endings_of(FileUse use);

/// "PDA, PLY or SPLATS": the names of a kind's formats, for messages; without those that need a converter.
std::string names_of(FileKind kind, FileUse use = FileUse::read);

/// What to do with what nothing here reads, splats in .ksplat and SOG as a folder, cameras in Alembic and
/// FBX, behind "found": " (splat-transform makes a .ply of it)". Empty for other files.
std::string_view conversion_advice(const fs::path& file);

}  // namespace astrosplat
