// Reads from the environment which mutant is active (ASTROSPLAT_MUTANT) and where to note the ones
// reached (ASTROSPLAT_MUTANT_REACHED: a file mapped by the tests and the programs they start alike).
// Before any other static object, because those may hold mutants.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

int astrosplat_mutant_active = -1;
static unsigned char astrosplat_reached_unread[1 << 16];
unsigned char* astrosplat_mutant_reached = astrosplat_reached_unread;

__attribute__((constructor(101))) static void read_astrosplat_mutant() {
    if (const char* id = std::getenv("ASTROSPLAT_MUTANT")) astrosplat_mutant_active = std::atoi(id);
    const char* path = std::getenv("ASTROSPLAT_MUTANT_REACHED");
    const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return;
    void* map = mmap(nullptr, sizeof astrosplat_reached_unread, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (map != MAP_FAILED) astrosplat_mutant_reached = static_cast<unsigned char*>(map);
    close(file);
}

namespace astrosplat {

/// A shader's text with the macro's places replaced by true or false.
std::string astrosplat_mutated_shader(std::string text) {
    const std::string macro = "ASTROSPLAT_MUTANT(";
    for (std::size_t at; (at = text.find(macro)) != std::string::npos;) {
        const std::size_t number = at + macro.size(), end = text.find(')', number);
        const bool on = astrosplat_mutant(std::stoi(text.substr(number, end - number)));
        text.replace(at, end + 1 - at, on ? "true" : "false");
    }
    return text;
}

}  // namespace astrosplat
