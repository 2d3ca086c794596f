// cli/main.cpp: the program vitrail: one verb a capability (host/cli/<verb>.cpp). With --json the result is a JSON document and the only
// thing on standard output; notes, progress and errors are on standard error.
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/version.h>

#include "cli/progress.h"
#include "cli/verb.h"

namespace {

int exitCode(vitrail::ErrorCode code) {
    switch (code) {
        case vitrail::ErrorCode::badOption:
            return 2;
        case vitrail::ErrorCode::cancelled:
            return 130;
        default:
            return 1;
    }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace vitrail::cli;
    sinceStartMs();
    CLI::App app{"Voxels of triangle meshes, and light through them, on any OpenCL device.", "vitrail"};
    app.set_version_flag("--version", "vitrail " VITRAIL_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    app.footer(
        "`vitrail VERB --help` tells about one. Exit codes: 0, 1 error, 2 bad arguments, 3 an --expect not met, 130 interrupted.\n"
        "Environment: VITRAIL_DEVICE, VITRAIL_MEMORY_LIMIT (3G, 512M), VITRAIL_CACHE_DIR, VITRAIL_BUILD_OPTIONS, VITRAIL_KERNEL_PATH.");
    Run run;
    addInfo(app, run);
    addShape(app, run);
    addVoxelize(app, run);
    addCompare(app, run);
    addRender(app, run);
    addJudge(app, run);
    if (argc == 1) {
        std::fputs(app.help().c_str(), stderr);
        return 2;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    catchInterrupts();
    try {
        return run();
    } catch (const vitrail::Error& error) {
        note(error.code() == vitrail::ErrorCode::cancelled ? "vitrail: interrupted; nothing was written" : error.what());
        return exitCode(error.code());
    } catch (const std::bad_alloc&) {
        note("vitrail: the machine is out of memory\n  try:    a smaller grid or mesh");
    } catch (const std::exception& error) {
        note(std::string("vitrail: ") + error.what());
    }
    return 1;
}
