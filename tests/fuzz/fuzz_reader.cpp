// libFuzzer's entry for the reader that ASTROSPLAT_READER names: InputError is the answer to bad input,
// everything else reaches the fuzzer.

#include "core/error.h"
#include "core/log.h"
#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto& target = astrosplat::fuzz::target(ASTROSPLAT_READER);
    astrosplat::set_log_level(astrosplat::LogLevel::error);
    try {
        target.read(std::string_view(reinterpret_cast<const char*>(data), size));
    } catch (const astrosplat::InputError&) {
    }
    return 0;
}
