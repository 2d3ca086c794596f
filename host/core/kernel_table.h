// core/kernel_table.h: the kernel sources inside the binary, as kernels/embed.cmake wrote them.
#pragma once
#include <cstddef>
#include <span>

namespace vitrail::inline v0::detail {

struct KernelFile {
    const char* name;  // "voxelize/points.cl", "layout/grid.h"
    const char* text;
    std::size_t length;
};

std::span<const KernelFile> kernelTable();

}  // namespace vitrail::inline v0::detail
