// The one table of the file formats that the program reads and writes. Readers, writers, import, `info`, the
// file dialogs and their messages all ask it, so that they cannot disagree.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat {

/// What a file is to a person. A look is a scene file too, until its content says otherwise.
enum class FileKind { unknown, scene, look, picture, mesh, splats };

struct FileFormat {
    std::string_view id;    // pictures: the name of OpenImageIO's plug-in
    std::string_view name;  // for people
    FileKind kind = FileKind::unknown;
    std::vector<std::string_view> endings;  // lower case, with the dot; the usual one first
    std::vector<std::string_view> magic;    // how such files begin, '?' for any byte; none: text of any kind
    bool written = false;                   // as a frame, as splats or as a scene; all formats are read
};

std::span<const FileFormat> file_formats();

/// The format that a file's name promises, in capitals or not; nullptr for other names.
const FileFormat* format_by_name(const std::filesystem::path& file);

/// The format of a file to be read: by its first bytes where a format has such, else by its name. nullptr for
/// other files.
const FileFormat* format_of_file(const std::filesystem::path& file);

/// FileKind::unknown where there is no format.
FileKind kind_of(const FileFormat* format);

enum class FileUse { read, written };

/// The endings of all formats of these kinds.
std::vector<std::string> endings_of(std::initializer_list<FileKind> kinds, FileUse use = FileUse::read);

/// "PDA, PLY or SPLATS": the names of a kind's formats, for messages.
std::string names_of(FileKind kind, FileUse use = FileUse::read);

}  // namespace astrosplat
