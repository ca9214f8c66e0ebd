use super::*;

/// A square of two triangles for each of n × n cells, on vertices of their own, as STL files have them.
fn wave(n: u16) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let point = |x: u16, y: u16| [f32::from(x), f32::from(y), (f32::from(x) * 0.3).sin()];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for x in 0..n {
        for y in 0..n {
            for corners in [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]] {
                let first = u32::try_from(vertices.len()).unwrap();
                vertices.extend(corners.map(|(a, b)| point(x + a, y + b)));
                triangles.push([first, first + 1, first + 2]);
            }
        }
    }
    (vertices, triangles)
}

#[test]
fn vertices_that_coincide_are_one_and_stay_where_they_are() {
    let (vertices, triangles) = wave(20);
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (21 * 21, 800));
    for (all, now) in triangles.iter().zip(&mesh.triangles) {
        for (k, now) in all.iter().zip(now) {
            let (a, b) = (vertices[*k as usize], mesh.vertices[*now as usize]);
            assert!((0..3).all(|k| (f64::from(a[k]) - b[k]).abs() < 20.0 / 16384.0), "{a:?} {b:?}");
        }
    }
}

#[test]
fn large_meshes_get_coarser_and_keep_their_extent() {
    let (vertices, triangles) = wave(250);
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    assert!((1000..=MOST_TRIANGLES).contains(&mesh.triangles.len()), "{}", mesh.triangles.len());
    let most = mesh.vertices.iter().map(|v| v[0]).fold(0.0, f64::max);
    assert!((245.0..=250.0).contains(&most), "{most}");
}

#[test]
fn what_is_no_triangle_is_left_out() {
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN, 0.0, 0.0]];
    let mesh = Mesh::new(&vertices, &[[0, 1, 2], [0, 1, 3], [0, 1, 9], [1, 1, 2]]).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(Mesh::new(&vertices, &[[0, 1, 3]]), None);
    assert_eq!(Mesh::new(&[[1.0; 3]], &[[0, 0, 0]]), None);
    assert_eq!(Mesh::new(&[], &[]), None);
}
