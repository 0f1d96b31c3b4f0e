// A layer whose set stays on disk: the look goes over a block of its .splats file whenever the renderer asks
// for one. In: the file and a look. Out: ShadedBlocks, whose splats have the bits that apply_look gives them.
#pragma once

#include "core/bounds.h"
#include "core/progress.h"
#include "look/apply.h"
#include "look/shared_uniforms.h"
#include "splat_files/native.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// Why a file's splats have to be in memory as a whole under a look, for a message; empty: they need not.
std::string why_not_streamed(const NativeBlocks& file, const Look& look);

class StreamedSet : public ShadedBlocks {
  public:
    /// Opens the file, which is a whole set's. Throws InputError.
    explicit StreamedSet(const fs::path& file) : file_(file) {}

    const NativeBlocks& file() const { return file_; }
    /// Of all positions, before any look.
    Bounds bounds() const;

    /// The look that shade() gives from now on. Reads the whole file once, the first time with its checksums,
    /// to know what is in the blocks. The look's map has to stay where it is. Throws InputError as apply_look
    /// does, and Cancelled; then the set has no look.
    void set_look(const Look& look, const LookInputs& inputs, const Progress& progress);

    void shade(std::size_t block, ShadedSplats& out) const override;

  private:
    void find_max_distance(const Progress& progress);
    void read_and_shade(std::size_t block, NativeBlocks::Check check, ShadedSplats& out) const;

    NativeBlocks file_;
    SplatSetFacts facts_ = file_.facts();
    bool is_checked_ = false;  // every block has the file's checksum
    bool has_max_distance_ = false;
    OptionalColumns wanted_;
    PreparedLook uniforms_{};
    const Image* map_ = nullptr;
};

}  // namespace astrosplat
