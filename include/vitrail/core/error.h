// vitrail/core/error.h: the one exception of the library: a code to switch on and a message that says what, where, while
// doing what, and what to try.
#pragma once
#include <stdexcept>
#include <string>

namespace vitrail {
inline namespace v0 {

enum class ErrorCode {
    badOption,     ///< an option outside its stated range, or options that exclude each other
    badInput,      ///< a mesh, scene or array that cannot be used (index out of range, NaN vertex, nothing in it)
    badFile,       ///< a file that cannot be read, parsed or written
    unsupported,   ///< a well-formed request or file that this build or device does not serve
    outOfMemory,   ///< over the memory limit or over what the device allows; thrown before memory is taken
    noDevice,      ///< no OpenCL platform or no matching device
    deviceFailed,  ///< an OpenCL call failed; the message has its name and code
    buildFailed,   ///< a kernel did not compile; the message has the log
    cancelled,     ///< the progress callback returned false; outputs are unchanged, the queue stays usable
};

/// The code's name as written above, for reports: "badOption".
const char* name(ErrorCode code);

/// Parts of a message. Empty parts are left out.
struct ErrorText {
    std::string what{};    ///< "conservative: a grid of ... needs 8.00 GiB of bits; this device allows 2.00 GiB in one buffer"
    std::string where{};   ///< "device: pthread-skylake (PoCL 3.1)", "bunny.obj:17"
    std::string during{};  ///< "voxelizing 69451 triangles"
    std::string remedy{};  ///< "2580 voxels along the longest axis or fewer"
};

class Error : public std::runtime_error {
public:
    Error(ErrorCode code, ErrorText text);

    ErrorCode code() const { return code_; }
    const ErrorText& text() const { return text_; }

private:
    ErrorCode code_;
    ErrorText text_;
};

}  // namespace v0
}  // namespace vitrail
