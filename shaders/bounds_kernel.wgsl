// Bounds kernel: draws ξ of each light, and bounds the light's range. Needs `kernel.wgsl`.

@group(0) @binding(2) var<storage, read_write> slc_new_projected: array<SlcProjected>;
@group(0) @binding(3) var<storage, read_write> slc_new_xis: array<f32>;

/// One thread for each light.
@compute @workgroup_size(64)
fn slc_bound_lights(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    if index >= slc_this.lights {
        return;
    }
    let light = slc_light(index);
    let xi = slc_xi_of_light(slc_this, index);
    let scale = slc_scale(light.flux, slc_this.delta, xi);
    let bound = slc_placed(slc_unit_bound(light), light.position, scale);
    slc_new_xis[index] = xi;
    slc_new_projected[index] = slc_project(bound, slc_this.camera);
}
