// modules/modules.h: what a module offers, as `vitrail_images` or `vitrail_vdb`: a table of the functions of the part it holds. Program
// and modules are built and installed together; the version tells when they were not.
#pragma once
#include <vitrail/io/vdb.h>

#include "images/images.h"

namespace vitrail::io_detail {

struct ImagesModule {
    const char* version;
    decltype(&decodeImage) decode;
    decltype(&encodeExr) exr;
    decltype(&encodePng) png;
};

struct VdbModule {
    const char* version;
    decltype(&saveVdb) save;
    decltype(&saveVdbCells) saveCells;
    decltype(&loadVdb) load;
    decltype(&loadVdbCells) loadCells;
};

}  // namespace vitrail::io_detail
