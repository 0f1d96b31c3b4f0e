// The figures of a batch run as JSON (--stats): per frame, per layer, and of the whole run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline.h"

namespace astrosplat {

struct FrameFigures {
    std::int64_t frame = 0;
    std::filesystem::path file;
    double seconds = 0.0;         // look, render and write
    double write_seconds = 0.0;   // encoding, compressing, until it is on the disk
    double render_seconds = 0.0;  // from shaded splats to the finished float image in memory
    std::int64_t splats_in = 0, splats_drawn = 0;
    std::string sha256;  // of the float pixels' bytes
};

struct FailedFrame {
    std::int64_t frame = 0;
    std::filesystem::path file;
    std::string error;
};

struct RunFigures {
    std::vector<FrameFigures> frames;  // those rendered and written in this run
    std::vector<FailedFrame> failed;
    std::vector<LayerStatistics> layers;
    double seconds = 0.0;
};

/// Writes the figures whole or not at all. Throws OutputError.
void write_stats(const std::filesystem::path& file, const RunFigures& figures);

}  // namespace astrosplat
