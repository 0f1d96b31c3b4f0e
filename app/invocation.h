// A command line that was read, before anything is done.
#pragma once

#include <functional>
#include <string>

#include "batch.h"
#include "commands.h"
#include "viewer/run_viewer.h"

namespace astrosplat {

/// Options that every command takes.
struct CommonOptions {
    std::string threads, cache;
    bool no_cache = false, verbose = false, quiet = false;
};

struct Invocation {
    CommonOptions common;
    bool batch = false;
    std::string input;  // what the viewer opens
    BatchOptions batch_options;
    SubmitOptions submit;  // when its system is given; beside batch_options
    StatusOptions status;
    ScreenshotOptions screenshot;  // when its output is given
    NewOptions create;
    PrepareOptions prepare;
    GenerateOptions generate;
    ConvertOptions convert;
    ExportOptions export_options;
    CameraOptions camera;
    InfoOptions info;
    CompareOptions compare;
    FidelityOptions fidelity;
    VerifyOptions verify;
    ParametersOptions parameters;
    std::string manual, shell;    // which page, whose completion
    std::function<int()> action;  // of the subcommand, when there is one
};

}  // namespace astrosplat
