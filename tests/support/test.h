// Taken by nearly every test: GoogleTest, the standard library's files, texts, maps and threads, exact
// maths, messages of errors, a folder of its own, a silent log, and bits that must be the same.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "core/error.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "core/standard.h"
#include "support/bits.h"
#include "support/errors.h"
#include "support/process_state.h"
#include "support/quiet.h"
#include "support/temp_folder.h"
