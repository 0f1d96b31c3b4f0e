// One picture file on its way to the disk: OpenImageIO encodes, an AtomicFile takes the bytes, so that
// every write that fails is an error whatever the format's plug-in makes of it. Included by the writers of
// pictures alone.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/guarded_file.h"

namespace astrosplat {

class PictureFile {
  public:
    /// Writes the header of a picture in the `format` that OpenImageIO knows under this name or ending
    /// ("tiff", "x.png"). Throws OutputError, as all functions here.
    PictureFile(const std::filesystem::path& file, const std::string& format, const OIIO::ImageSpec& spec,
                Existing existing = Existing::replace);

    /// All rows, or rows begin .. end of the data window's y, from memory where a pixel takes x_stride bytes.
    void write_all(OIIO::TypeDesc type, const void* pixels, OIIO::stride_t x_stride = OIIO::AutoStride);
    void write_rows(std::int64_t begin, std::int64_t end, OIIO::TypeDesc type, const void* pixels);

    /// Finishes the file, which then appears under its name.
    void commit();

  private:
    /// Takes the plug-in's bytes, and remembers what went wrong: plug-ins need not report it.
    class Sink : public OIIO::Filesystem::IOProxy {
      public:
        Sink(const std::filesystem::path& file, Existing existing);
        const char* proxytype() const override { return "astrosplat"; }
        std::size_t write(const void* bytes, std::size_t size) override;
        std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t offset) override;
        std::size_t size() const override { return static_cast<std::size_t>(file.size()); }

        AtomicFile file;
        GuardedFile guarded;
    };
    /// Throws the sink's failure, else the plug-in's where it is not `done`.
    void check(bool done);

    Sink sink_;  // outlives out_, which may write at its end
    std::unique_ptr<OIIO::ImageOutput> out_;
};

}  // namespace astrosplat
