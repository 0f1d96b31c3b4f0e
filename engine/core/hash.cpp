// SHA-256 by OpenSSL's EVP interface.
#include "core/hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <new>

#include "core/file.h"

namespace astrosplat {

namespace {

std::string hex_of(const unsigned char* bytes, unsigned int size) {
    std::string text;
    for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", bytes[i]);
    return text;
}

}  // namespace

struct Sha256::State {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
    if (!state_->context || EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr) != 1)
        throw std::bad_alloc();
}

Sha256::~Sha256() = default;

Sha256& Sha256::add(const void* bytes, std::size_t size) {
    EVP_DigestUpdate(state_->context, bytes, size);
    return *this;
}

std::string Sha256::hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    [[maybe_unused]] const int done = EVP_DigestFinal_ex(state_->context, digest, &size);
    assert(done == 1);
    return hex_of(digest, size);
}

std::optional<std::string> digest_of(const std::string& method, std::string_view bytes) {
    const EVP_MD* const known = EVP_get_digestbyname(method.c_str());
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    if (!known || EVP_Digest(bytes.data(), bytes.size(), digest, &size, known, nullptr) != 1) return {};
    return hex_of(digest, size);
}

std::string sha256_of_file(const fs::path& file, const Progress& progress) {
    InputFile in(file);
    Sha256 hash;
    std::vector<char> block(std::size_t{1} << 20);
    while (const std::size_t got = in.read(block.data(), block.size())) {
        progress.check();
        hash.add(block.data(), got);
    }
    return hash.hex();
}

}  // namespace astrosplat
