/// tarmac-estimate: runs one estimator over one recording, in a process of its own. It is handed a recording, options
/// and an output folder, and links nothing that knows the truth.
///
/// stdout: log lines. stderr or --progress-fd: "progress FRACTION NOTE" lines.
/// Exit codes: 0 done (also when the method could not initialise: its status says so), 2 bad usage or input, 3 the
/// method failed (its results until then are kept), 4 internal error.
#include "tools/estimate/program.h"

int main(int argc, char** argv) {
  return tarmac::tools::estimate_program(argc, argv);
}
