#pragma once
// The list of laws that a scene may name and that the contract tests check.  A new law is one line here.
#include "core/type_list.hpp"
#include "materials/cohesive_cam_clay.hpp"
#include "materials/corotated.hpp"
#include "materials/drucker_prager.hpp"
#include "materials/elastic_herschel_bulkley.hpp"
#include "materials/hencky.hpp"
#include "materials/herschel_bulkley.hpp"
#include "materials/johnson_cook.hpp"
#include "materials/linear_elastic.hpp"
#include "materials/linear_first_piola.hpp"
#include "materials/mechanical_threshold.hpp"
#include "materials/modified_cam_clay.hpp"
#include "materials/mohr_coulomb.hpp"
#include "materials/mu_i.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/newtonian.hpp"
#include "materials/porous_ductile.hpp"
#include "materials/snow.hpp"
#include "materials/viscoelastic.hpp"
#include "materials/von_mises.hpp"

namespace talus {

// clang-format off
using Laws = TypeList<
    LinearElastic,
    NeoHookean,
    Corotated,
    Hencky,
    Viscoelastic,
    DruckerPrager,
    MohrCoulomb,
    ModifiedCamClay,
    CohesiveCamClay,
    Snow,
    MuI,
    Newtonian,
    HerschelBulkley,
    ElasticHerschelBulkley,
    VonMises,
    JohnsonCook,
    MechanicalThreshold,
    PorousDuctile,
    LinearFirstPiola>;
// clang-format on

}  // namespace talus
