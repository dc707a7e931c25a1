pub(super) fn on_axes<T: Send>(much: bool, of: impl Fn(usize) -> T + Sync) -> [T; 3] {
    if !much {
        return [0, 1, 2].map(of);
    }
    let (x, (y, z)) = rayon::join(|| of(0), || rayon::join(|| of(1), || of(2)));
    [x, y, z]
}
