// The descriptions of the structs of scene files: the only source that instantiates them.
#include "io/document/make_value_type.hpp"
#include "io/scene/point_test.hpp"
#include "io/scene/scene.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

template const ValueType& value_type<Scene>();
template const ValueType& value_type<PointTest>();

// Those that the manual treats in a way of their own.
template const ValueType& value_type<AnyLaw>();
template const ValueType& value_type<Shape>();
template const ValueType& value_type<SimpleShape>();
template const ValueType& value_type<Box>();
template const ValueType& value_type<SurfaceSpec>();
template const StructType& struct_type<ParticleOutputSpec>();
template const StructType& struct_type<MeshOutputSpec>();
template const StructType& struct_type<HistoryOutputSpec>();
template const StructType& struct_type<PointSpec>();
template const StructType& struct_type<FrontSpec>();
template const StructType& struct_type<WallSpec>();
template const StructType& struct_type<MovedSpec>();

}  // namespace talus
