#include "io/output/vtk_blocks.hpp"

#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkZLibDataCompressor.h>

#include <stdexcept>
#include <string>

namespace talus {

namespace {

/// Suppresses all output of VTK while it exists.
class SilentVtk {
 public:
  SilentVtk() : window_(vtkOutputWindow::GetInstance()), log_(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkOutputWindow::SetInstance(heard_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~SilentVtk()
  {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(log_);
  }
  SilentVtk(const SilentVtk&) = delete;
  SilentVtk& operator=(const SilentVtk&) = delete;

 private:
  vtkSmartPointer<vtkOutputWindow> window_;
  vtkLogger::Verbosity log_;
  vtkNew<vtkStringOutputWindow> heard_;
};

vtkSmartPointer<vtkDataCompressor> compressor_of(std::string_view name)
{
  if (name == "vtkLZ4DataCompressor")
    return vtkSmartPointer<vtkLZ4DataCompressor>::New();
  if (name == "vtkZLibDataCompressor")
    return vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (name == "vtkLZMADataCompressor")
    return vtkSmartPointer<vtkLZMADataCompressor>::New();
  throw std::invalid_argument("compressor \"" + std::string(name.substr(0, 40)) + "\" is not one of VTK's LZ4, ZLib and LZMA");
}

}  // namespace

struct BlockUnpacker::Parts {
  SilentVtk silent;
  vtkSmartPointer<vtkDataCompressor> compressor;
};

BlockUnpacker::BlockUnpacker(std::string_view compressor) : parts_(std::make_unique<Parts>())
{
  parts_->compressor = compressor_of(compressor);
}
BlockUnpacker::~BlockUnpacker() = default;

bool BlockUnpacker::operator()(std::span<const char> packed, std::span<std::byte> to)
{
  return parts_->compressor->Uncompress(reinterpret_cast<const unsigned char*>(packed.data()), packed.size(),
                                        reinterpret_cast<unsigned char*>(to.data()), to.size()) == to.size();
}

}  // namespace talus
