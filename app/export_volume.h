// A scene's shaded splats as an OpenVDB file, for export. Prints one line to stdout.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "core/progress.h"
#include "pipeline.h"
#include "render/frame.h"
#include "volumes/openvdb_file.h"

namespace astrosplat {

struct VolumeExport {
    double gain = 1.0;        // of light
    double voxel_size = 0.0;  // scene units; 0: default_voxel_size
    VolumeWords words;
    WriteTarget target;
};

/// What a volume's file says about itself; `input_credit`: of the scene's files, where it gives none.
VolumeWords words_about(const FrameScene& frame, const std::string& input_credit);

/// False where no splat is seen, and then nothing is written. Throws InputError (memory, voxels too small),
/// OutputError, Cancelled.
bool export_volume(const std::vector<RenderLayer>& layers, const Camera& camera, const VolumeExport& volume,
                   const Progress& progress);

}  // namespace astrosplat
