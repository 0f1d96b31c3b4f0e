// Camera files, star catalogues, captures of every format and metadata of pictures for the fuzzer: seeds, and
// checks of what was read. Readers throw InputError for bad input,
// std::logic_error for results that cannot be.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::fuzz {

std::vector<std::string> camera_seeds();
/// By the reader that the bytes look most like: elsewhere a format is recognised by its name's ending.
std::size_t read_camera_bytes(std::string_view bytes);

std::string bzipped(std::string text);

/// Hipparcos, HYG, a table with names, packed by gzip and bzip2, a picture's table, VOTables, FITS tables.
std::vector<std::string> catalogue_seeds();
std::size_t read_catalogue_bytes(std::string_view bytes);

/// PLY files of Gaussians; glTF files of them, binary and as text; USD.
std::vector<std::string> gaussian_ply_seeds();
std::vector<std::string> gltf_seeds();
std::vector<std::string> usda_seeds();
/// SPZ of every version, with extensions; SuperSplat's compressed PLY; .splat; SOG.
std::vector<std::string> spz_seeds();
std::vector<std::string> compressed_ply_seeds();
std::vector<std::string> dot_splat_seeds();
std::vector<std::string> sog_seeds();
std::size_t read_spz_bytes(std::string_view bytes);
std::size_t read_dot_splat_bytes(std::string_view bytes);
std::size_t read_sog_bytes(std::string_view bytes);
std::size_t read_gaussian_ply_bytes(std::string_view bytes);
std::size_t read_gltf_bytes(std::string_view bytes);
std::size_t read_usda_bytes(std::string_view bytes);

/// XMP packets with AVM, also among other bytes, as pictures have them; headers of FITS pictures.
std::vector<std::string> xmp_seeds();
std::vector<std::string> fits_metadata_seeds();
std::size_t read_xmp_bytes(std::string_view bytes);
std::size_t read_fits_metadata_bytes(std::string_view bytes);

/// A FITS file by hand: cards of 80 characters in blocks of 2880 bytes, then 4 x 3 big-endian 16-bit numbers.
std::string fits(const std::vector<std::string>& cards);

}  // namespace astrosplat::fuzz
