#include "io/world/vtk_messages.h"

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <mutex>

namespace tarmac::io::world {

namespace {

/// One window serves the whole process.
std::mutex& window_mutex() {
  static std::mutex mutex;
  return mutex;
}

class Keeper final : public vtkOutputWindow {
 public:
  static Keeper* New();
  vtkTypeMacro(Keeper, vtkOutputWindow);
  void DisplayText(const char* text) override {
    if (first.empty() && text != nullptr) first = text;  // a damaged file may bring millions
  }
  std::string first;
};
vtkStandardNewMacro(Keeper);

}  // namespace

struct VtkMessages::State {
  std::lock_guard<std::mutex> lock{window_mutex()};
  vtkSmartPointer<vtkOutputWindow> before{vtkOutputWindow::GetInstance()};
  vtkSmartPointer<Keeper> keeper{vtkSmartPointer<Keeper>::New()};
};

VtkMessages::VtkMessages() : state_(new State) {
  vtkOutputWindow::SetInstance(state_->keeper);
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow::SetInstance(state_->before);
  delete state_;
}

std::string VtkMessages::first() const {
  std::string text = state_->keeper->first;
  // "ERROR: In file.cxx, line 17\nvtkSTLReader (0x55..): what is wrong\n\n"
  if (const std::size_t line_end = text.find('\n'); line_end != std::string::npos && text.find("In ") < line_end) {
    text.erase(0, line_end + 1);
  }
  if (const std::size_t object_end = text.find("): "); object_end != std::string::npos && text.starts_with("vtk")) {
    text.erase(0, object_end + 3);
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace tarmac::io::world
