// Enters: a bsdf element with others nested in it.
// Leaves: the material that says what becomes of them: which side, what share, which normal.
#pragma once

#include "loader.h"

namespace ajar {

void load_twosided(Params& params, Material& material);
void load_mask(Params& params, Material& material);
void load_blend(Params& params, Material& material);
void load_mixture(Params& params, Material& material);
void load_bumpmap(Params& params, Material& material);
void load_normalmap(Params& params, Material& material);

}  // namespace ajar
