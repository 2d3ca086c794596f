// Every seed and finding of the fuzzers (tests/fuzz/corpus), and every file made from one by cutting it short or by changing a
// byte, ends in a scene or a vitrail::Error, and asks for no more memory than its size explains.
#include <vitrail/io/image.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <random>

#include "io/readers.h"
#include "tests/io/mesh_reading.h"

namespace {
std::atomic<std::size_t> largestRequest{0};
}

// Replaced for this program, so that a count in a header that sizes an array is seen even where the system would grant it.
[[gnu::noinline]] void* operator new(std::size_t size) {
    std::size_t seen = largestRequest.load(std::memory_order_relaxed);
    while (size > seen && !largestRequest.compare_exchange_weak(seen, size, std::memory_order_relaxed)) {
    }
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace vitrail {
namespace {

namespace fs = std::filesystem;

class EveryCorpus : public testing::TestWithParam<const char*> {
protected:
    // True when it gave a scene.
    bool read(std::string_view bytes) {
        const std::string reader = GetParam();
        const auto raw = std::as_bytes(std::span(bytes.data(), bytes.size()));
        try {
            if (reader == "picture")
                loadPictureFromMemory(raw, "corpus");
            else
                loadSceneFromMemory(raw, reader, "corpus");
            return true;
        } catch (const Error&) {
            return false;
        }
    }
};

TEST_P(EveryCorpus, GivesASceneOrAnError) {
    const fs::path folder = fs::path(VITRAIL_FUZZ_CORPUS) / GetParam();
    ASSERT_TRUE(fs::is_directory(folder)) << folder;
    const bool ours = std::string_view("ply stl off obj").find(GetParam()) != std::string_view::npos;
    std::minstd_rand random(7);
    int files = 0, scenes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().filename().string());
        const std::vector<std::byte> raw = io_detail::readFile(entry.path());
        const std::string whole(reinterpret_cast<const char*>(raw.data()), raw.size());
        ++files;
        largestRequest = 0;
        scenes += read(whole);
        // 64 bytes for each of the file's, and what libraries and streams take to start with.
        if (ours) {
            EXPECT_LE(largestRequest.load(), 64 * whole.size() + 65536);
        }
        if (whole.size() > 4000) continue;
        for (std::size_t size = 0; size<whole.size(); size += whole.size()> 1000 ? 7 : 1) read(std::string_view(whole).substr(0, size));
        for (int i = 0; i < 400 && !whole.empty(); ++i) {
            std::string changed = whole;
            for (int n = 0; n < 1 + i % 3; ++n) changed[random() % changed.size()] = static_cast<char>(random() >> 8);
            largestRequest = 0;
            read(changed);
            if (ours) {
                EXPECT_LE(largestRequest.load(), 64 * changed.size() + 65536);
            }
        }
    }
    EXPECT_GT(files, 0);
    if (ours) {
        EXPECT_GT(scenes, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Readers, EveryCorpus, testing::Values("ply", "stl", "off", "obj", "gltf", "json", "picture"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace vitrail
