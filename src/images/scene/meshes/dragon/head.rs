//! The head of the dragon.

use glam::{Vec3, vec4};

use crate::scene::meshes::sdf::{Blend, Frame, Sdf};

pub fn model(sdf: &mut Sdf, neck: Frame) {
    let origin = neck.at(0.0, 0.01, 0.12);
    let head = Frame::looking(origin, Vec3::new(0.80, 0.04, 0.60), Vec3::Y);
    skull(sdf, &head);
    jaws(sdf, &head);
    eyes(sdf, &head);
    horns(sdf, &head);
    frill(sdf, &head);
    teeth(sdf, &head);
    hair(sdf, &head);
}

fn skull(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend { displacement: 0.5, ..Blend::smooth(0.08) });
    sdf.ellipsoid_in(head, [0.0, 0.03, 0.0], [0.20, 0.19, 0.25]);
    sdf.group(Blend { displacement: 0.4, ..Blend::smooth(0.07) });
    sdf.cone(head.at(0.0, 0.02, 0.10), 0.16, head.at(0.0, 0.0, 0.50), 0.105);
    sdf.group(Blend::undisplaced(0.05)).ellipsoid_in(head, [0.0, 0.07, 0.53], [0.095, 0.075, 0.085]);
}

fn jaws(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend { displacement: 0.4, ..Blend::smooth(0.04) });
    sdf.cone(head.at(0.0, -0.10, 0.02), 0.12, head.at(0.0, -0.36, 0.36), 0.062);
    sdf.group(Blend::subtract(0.03)).cone(head.at(0.0, -0.12, 0.16), 0.075, head.at(0.0, -0.19, 0.58), 0.125);

    sdf.group(Blend::undisplaced(0.02));
    for side in [-1.0, 1.0] {
        let lip = [
            vec4(side * 0.135, -0.06, 0.12, 0.03),
            vec4(side * 0.125, -0.045, 0.30, 0.028),
            vec4(side * 0.085, -0.05, 0.48, 0.026),
            vec4(0.0, -0.05, 0.575, 0.026),
        ];
        sdf.tube_in(head, &lip, 4);
    }
    sdf.group(Blend::undisplaced(0.02));
    let tongue = [
        vec4(0.0, -0.16, 0.12, 0.05),
        vec4(0.0, -0.20, 0.30, 0.042),
        vec4(0.0, -0.26, 0.44, 0.034),
        vec4(0.0, -0.25, 0.54, 0.024),
        vec4(0.0, -0.18, 0.60, 0.013),
    ];
    sdf.tube_in(head, &tongue, 4);
}

fn eyes(sdf: &mut Sdf, head: &Frame) {
    for side in [-1.0, 1.0] {
        sdf.group(Blend::undisplaced(0.03));
        sdf.cone(head.at(side * 0.10, 0.14, 0.30), 0.042, head.at(side * 0.17, 0.20, 0.02), 0.05);
        sdf.group(Blend::subtract(0.02)).sphere(head.at(side * 0.185, 0.095, 0.17), 0.062);
        sdf.group(Blend::undisplaced(0.006)).sphere(head.at(side * 0.152, 0.098, 0.165), 0.052);
        sdf.group(Blend::undisplaced(0.02)).sphere(head.at(side * 0.06, 0.11, 0.56), 0.042);
        sdf.group(Blend::subtract(0.01)).sphere(head.at(side * 0.068, 0.11, 0.61), 0.026);
    }
}

fn horns(sdf: &mut Sdf, head: &Frame) {
    for side in [-1.0, 1.0] {
        sdf.group(Blend::undisplaced(0.03));
        let horn = [
            vec4(side * 0.10, 0.17, 0.00, 0.062),
            vec4(side * 0.15, 0.34, -0.10, 0.052),
            vec4(side * 0.20, 0.46, -0.28, 0.040),
            vec4(side * 0.23, 0.50, -0.48, 0.027),
            vec4(side * 0.22, 0.60, -0.64, 0.013),
        ];
        sdf.tube_in(head, &horn, 5);
        sdf.group(Blend::undisplaced(0.02));
        let prong = [
            vec4(side * 0.16, 0.38, -0.14, 0.034),
            vec4(side * 0.21, 0.50, -0.14, 0.026),
            vec4(side * 0.24, 0.60, -0.20, 0.013),
        ];
        sdf.tube_in(head, &prong, 4);
        sdf.group(Blend::smooth(0.03));
        let ear = [
            vec4(side * 0.19, 0.08, -0.08, 0.045),
            vec4(side * 0.31, 0.12, -0.18, 0.05),
            vec4(side * 0.42, 0.17, -0.30, 0.013),
        ];
        sdf.tube_in(head, &ear, 4);
    }
}

fn frill(sdf: &mut Sdf, head: &Frame) {
    for side in [-1.0, 1.0] {
        sdf.group(Blend::undisplaced(0.03));
        for (rise, out, length) in [(-0.42, 0.10, 0.30), (-0.24, 0.2, 0.36), (-0.05, 0.26, 0.34), (0.12, 0.22, 0.3)] {
            let foot = [side * 0.15, rise * 0.35, -0.04];
            let blade = [
                vec4(foot[0], foot[1], foot[2], 0.045),
                vec4(side * (0.15 + out * 0.7), rise * 0.7, -0.06 - length * 0.5, 0.042),
                vec4(side * (0.15 + out), rise + 0.04, -0.08 - length, 0.013),
            ];
            sdf.tube_in(head, &blade, 4);
        }
    }
    // A mane on top of the head.
    sdf.group(Blend::undisplaced(0.03));
    for (back, rise) in [(0.02, 0.14), (-0.1, 0.17), (-0.2, 0.16)] {
        sdf.cone(head.at(0.0, 0.16, back), 0.05, head.at(0.0, 0.2 + rise, back - 0.2), 0.013);
    }
}

fn teeth(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend::undisplaced(0.006));
    for side in [-1.0, 1.0] {
        for (z, x, long) in
            [(0.54, 0.045, 0.11), (0.46, 0.085, 0.07), (0.38, 0.105, 0.06), (0.30, 0.12, 0.06), (0.22, 0.13, 0.05)]
        {
            let root = head.at(side * x, -0.05, z);
            sdf.cone(root, 0.022, head.at(side * x * 0.95, -0.06 - long, z + 0.01), 0.011);
        }
        for (z, x, y, long) in [(0.38, 0.035, -0.32, 0.11), (0.31, 0.06, -0.265, 0.07), (0.24, 0.075, -0.215, 0.06)] {
            sdf.cone(head.at(side * x, y, z), 0.02, head.at(side * x, y + long, z + 0.02), 0.011);
        }
    }
}

fn hair(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend::undisplaced(0.025));
    for (z, y, long) in [(0.34, -0.39, 0.16), (0.24, -0.34, 0.22), (0.14, -0.28, 0.24), (0.03, -0.22, 0.2)] {
        sdf.cone(head.at(0.0, y, z), 0.04, head.at(0.0, y - 0.6 * long, z - 0.35 * long), 0.03);
        sdf.cone(head.at(0.0, y - 0.6 * long, z - 0.35 * long), 0.03, head.at(0.0, y - long, z - long), 0.011);
    }
    for side in [-1.0, 1.0] {
        let whisker = [
            vec4(side * 0.08, 0.04, 0.54, 0.026),
            vec4(side * 0.20, 0.06, 0.60, 0.023),
            vec4(side * 0.32, -0.04, 0.56, 0.020),
            vec4(side * 0.40, -0.16, 0.42, 0.018),
            vec4(side * 0.46, -0.20, 0.24, 0.015),
            vec4(side * 0.54, -0.14, 0.10, 0.012),
        ];
        sdf.tube_in(head, &whisker, 5);
    }
}
