(** Variances of the contact forces: what Eqs. 12-15 rest on, exactly in every layer, and how near that is to
    what is printed. The averages over all layers, and the height at which they are 1, follow. *)

From Coq Require Import ZArith Reals Lia Lra List.
From ForceDiffusion Require Import Roots Model Sums FirstOrder Lattice Geometry Mirror Forces Random Weights Exact.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** (σ/r)²/(1 − φ²)², the unit of the variances. *)
Definition unit_of (G : lattice) (sigma : R) : R :=
  (sigma / r G) ^ 2 / (1 - phi G ^ 2) ^ 2.

Lemma unit_positive G sigma : 0 < sigma -> 0 < unit_of G sigma.
Proof.
  intros H. pose proof (r_pos G). pose proof (divisor_positive G).
  unfold unit_of. apply Rdiv_lt_0_compat; apply pow_lt; [apply Rdiv_lt_0_compat; lra|].
  replace (phi G ^ 2) with (phi G * phi G) by ring. lra.
Qed.

(** One Δ: a form in three radii of one layer. *)
Lemma second_difference_variance (sigma : R) (M W : Z) (L : law W M sigma) (i j : Z) :
  within W M (i - 2) j -> within W M i j -> within W M (i + 2) j ->
  variance L (fun rho => second_difference rho i j 1) = 6 * sigma ^ 2.
Proof.
  intros A B C. assert (J : (0 <= j <= M)%Z) by (unfold within in B; site).
  pose (form := fun m => if (m =? j)%Z then
    cons (2, i) (cons (- 1, (i - 2)%Z) (cons (- 1, (i + 2)%Z) nil)) else nil : layer).
  destruct (form_variance W M sigma L form) with (c := 0) (w := 1)
    (f := fun rho => second_difference rho i j 1) as [_ V].
  - intros m Hm. unfold form, inside. destruct (Z.eqb_spec m j) as [->|]; [|apply Forall_nil].
    repeat (apply Forall_cons; [assumption|]). apply Forall_nil.
  - intros rho. unfold whole, form.
    rewrite (Sum_eq 0 M 0 M _ (fun m => on (m =? j)%Z (2 * rho i m - rho (i - 2)%Z m - rho (i + 2)%Z m))); auto.
    + rewrite Sum_at by site. unfold second_difference, delta_r. ring.
    + intros m Hm. destruct (m =? j)%Z; cbn [weigh on]; ring.
  - rewrite V. unfold squares, form.
    rewrite (Sum_eq 0 M 0 M _ (fun m => on (m =? j)%Z 6)); auto.
    + rewrite (Sum_at 0 M j (fun _ => 6)) by site. ring.
    + intros m Hm. destruct (m =? j)%Z; cbn [overlap on_one_radius on]; [|reflexivity]. compare_indices. ring.
Qed.

(** A force a (1 + change), the change being given by weights of radii. *)
Definition linear_force (G : lattice) (M i j : Z) (a : R) (w : weights) (rho : radii) : R :=
  a * (1 + whole M (layers i j w) rho / (2 * r G * (1 - phi G * phi G))).

Section Variances.
  Context (G : lattice) (M W : Z) (sigma : R) (spread : 0 < sigma) (L : law W M sigma).
  Context (X : radii -> centres) (F : radii -> forces) (P : forall rho, packing G M rho (X rho)).
  Local Notation unit := (unit_of G sigma).

  Section Contact.
    Variables i j : Z.
    Hypothesis at_contact : contact M i j.
    Hypothesis no_boundary : (Z.abs i + M + 2 <= W)%Z.

    (** Its mean, and its variance relative to that. *)
    Lemma linear_force_variance a w : a <> 0 ->
      let f := linear_force G M i j a w in
      expect L f = a /\ relative_variance L f = unit / 4 * squares M (layers i j w).
    Proof.
      intros Ha f. pose proof (r_pos G). pose proof (divisor_positive G).
      destruct (form_variance W M sigma L (layers i j w)
        (layers_inside W M i j w at_contact no_boundary) a (a / (2 * r G * (1 - phi G * phi G))) f)
        as [E V].
      { intros rho. unfold f, linear_force. field. lra. }
      split; [exact E|]. unfold relative_variance. rewrite V, E. unfold unit_of. field. repeat split; try lra.
    Qed.

    Local Notation height := (IZR M).
    Local Notation above := (IZR (M - j)).

    (** A bound on sums of squares is one on the variances. *)
    Lemma in_units v s p q b : v = unit / 4 * s -> Rabs (s - q) <= 4 * b -> 4 * p = q ->
      Rabs (v - unit * p) <= b * unit.
    Proof.
      intros -> H <-. pose proof (unit_positive G sigma spread).
      replace (unit / 4 * s - unit * p) with (unit / 4 * (s - 4 * p)) by field.
      rewrite Rabs_mult, (Rabs_right (unit / 4)) by lra.
      apply (Rmult_le_compat_l (unit / 4)) in H; lra.
    Qed.

    (** The force to first order under a load on the surface, and on every bead. *)
    Definition surface_linear a := linear_force G M i j a (surface_weights G j M).
    Definition bulk_linear a := linear_force G M i j (above * a) (averaged j M (surface_weights G j)).

    Theorem surface_linear_is f a : a <> 0 ->
      (forall rho, expands (f rho) a (a * change_plus G rho M i j)) ->
      let f1 := surface_linear a in
      linearised f f1 /\ expect L f1 = a /\ relative_variance L f1 = unit / 4 * surface_squares G j M.
    Proof.
      intros Ha E f1. pose proof (r_pos G). pose proof (divisor_positive G). split.
      - intros rho. eexists _, _. split; [apply E|].
        unfold f1, surface_linear, linear_force, whole.
        rewrite <- (surface_in_layers G rho i j ltac:(site) M M) by site. field. lra.
      - rewrite <- (surface_squares_are G i j M) by site. apply linear_force_variance, Ha.
    Qed.

    Theorem bulk_linear_is f a : a <> 0 ->
      (forall rho, expands (f rho) (above * a) (a * Sum (j + 1) M (fun l => change_plus G rho l i j))) ->
      let f1 := bulk_linear a in
      linearised f f1 /\ expect L f1 = above * a /\ relative_variance L f1 = unit / 4 * bulk_squares G j M.
    Proof.
      intros Ha E f1. pose proof (r_pos G). pose proof (divisor_positive G).
      assert (Hk : 1 <= above) by (apply (IZR_le 1); site). split.
      - intros rho. eexists _, _. split; [apply E|].
        unfold f1, bulk_linear, linear_force, whole.
        rewrite <- (bulk_in_layers G rho i j M) by site. field. lra.
      - rewrite <- (bulk_squares_are G i j M) by site. apply linear_force_variance.
        apply Rmult_integral_contrapositive_currified; [lra|exact Ha].
    Qed.

    (** Eq. 13: exactly, and near the printed form. *)
    Theorem surface_variance f : 0 < f ->
      (forall rho, carries M (X rho) (surface M f) (F rho)) ->
      let f1 := surface_linear (f / (2 * n_y G)) in
      linearised (fun rho => f_plus (F rho) i j) f1 /\ expect L f1 = f / (2 * n_y G) /\
        relative_variance L f1 = unit / 4 * surface_squares G j M /\
        Rabs (relative_variance L f1 - unit * (2 * (above * above) * (2 * IZR j + height)))
          <= (2 * height ^ 2 + height) * unit.
    Proof.
      intros Hf C f1. pose proof (n_y_pos G).
      destruct (surface_linear_is (fun rho => f_plus (F rho) i j) (f / (2 * n_y G))) as (A & E & V).
      - apply Rgt_not_eq, Rdiv_lt_0_compat; lra.
      - intros rho. apply (surface_force G M rho (X rho) (P rho) (F rho) i j at_contact f (C rho)).
      - repeat split; auto. eapply in_units; [exact V|exact (surface_near G j M ltac:(site) ltac:(site))|ring].
    Qed.

    (** Eq. 14: the same. *)
    Theorem bulk_variance g : 0 < g ->
      (forall rho, carries M (X rho) (bulk g) (F rho)) ->
      let f1 := bulk_linear (g / (2 * n_y G)) in
      linearised (fun rho => f_plus (F rho) i j) f1 /\ expect L f1 = above * (g / (2 * n_y G)) /\
        relative_variance L f1 = unit / 4 * bulk_squares G j M /\
        Rabs (relative_variance L f1 - unit * (3 / 10 * (above * above) * (4 * IZR j + height)))
          <= (3 / 8 * height ^ 2 + 5 / 4 * height) * unit.
    Proof.
      intros Hg C f1. pose proof (n_y_pos G).
      destruct (bulk_linear_is (fun rho => f_plus (F rho) i j) (g / (2 * n_y G))) as (A & E & V).
      - apply Rgt_not_eq, Rdiv_lt_0_compat; lra.
      - intros rho. apply (bulk_force G M rho (X rho) (P rho) (F rho) i j at_contact g (C rho)).
      - repeat split; auto. eapply in_units; [exact V|exact (bulk_near G j M ltac:(site) ltac:(site))|field].
    Qed.

    (** Eq. 12: the force less the weights of Eq. 12, squared. *)
    Definition by_braces (rho : radii) : R :=
      - (1 / (r G * (1 - phi G * phi G)) * Sum 1 M (fun m => braces_at j M m *
        (2 * rho (i - j + m)%Z m - rho (i - j + m - 2)%Z m - rho (i - j + m + 2)%Z m))).

    Theorem braces_miss :
      expect L (fun rho => (change_plus G rho M i j - by_braces rho) ^ 2)
        <= 29 * (height * height) * unit.
    Proof.
      pose proof (r_pos G). pose proof (divisor_positive G).
      set (w := less_main (surface_weights G j M) (braces_at j M)).
      destruct (form_variance W M sigma L (layers i j w)
        (layers_inside W M i j w at_contact no_boundary) 0 (1 / (2 * r G * (1 - phi G * phi G)))
        (fun rho => change_plus G rho M i j - by_braces rho)) as [E V].
      { intros rho. rewrite Rplus_0_l. unfold whole, w.
        rewrite (Sum_eq 0 M 0 M _ _ eq_refl eq_refl (fun m _ => less_main_weigh i j _ _ m rho)).
        rewrite Sum_plus, <- (surface_in_layers G rho i j ltac:(site) M M) by site.
        rewrite (Sum_first 0 M (fun m => on (1 <=? m)%Z _)) by site.
        replace (0 + 1)%Z with 1%Z by lia.
        rewrite (Sum_eq 1 M 1 M (fun m => on (1 <=? m)%Z _) (fun m => 2 * (braces_at j M m *
          (2 * rho (i - j + m)%Z m - rho (i - j + m - 2)%Z m - rho (i - j + m + 2)%Z m)))); auto.
        - unfold on, by_braces. rewrite Sum_scale. cbn [Z.leb Z.compare]. field. lra.
        - intros m Hm. unfold on. replace (1 <=? m)%Z with true by lia. reflexivity. }
      unfold variance in V. rewrite E in V.
      replace (fun rho => (change_plus G rho M i j - by_braces rho - 0) ^ 2)
        with (fun rho => (change_plus G rho M i j - by_braces rho) ^ 2) in V
        by (apply FunctionalExtensionality.functional_extensionality; intros; ring).
      rewrite V.
      replace ((1 / (2 * r G * (1 - phi G * phi G))) ^ 2 * (sigma ^ 2 * squares M (layers i j w)))
        with (unit / 4 * squares M (layers i j w)) by (unfold unit_of; field; lra).
      pose proof (unit_positive G sigma spread).
      pose proof (left_out_squares G i j M ltac:(site)) as S. fold w in S.
      apply (Rmult_le_compat_l (unit / 4)) in S; lra.
    Qed.
  End Contact.

  (** ** The mean over all layers, one contact of each *)

  Section Average.
    Variable across : Z -> Z.
    Hypothesis contacts : forall j, (0 <= j < M)%Z -> contact M (across j) j /\
      (Z.abs (across j) + M + 2 <= W)%Z.
    Hypothesis high : (1 <= M)%Z.
    Local Notation height := (IZR M).

    Lemma layers_counted (v profile : Z -> R) total b c :
      (forall j, (0 <= j < M)%Z -> Rabs (v j - unit * profile j) <= b * unit) ->
      Rabs (Sum 0 (M - 1) profile - height * total) <= height * c ->
      Rabs (Sum 0 (M - 1) v / height - unit * total) <= (b + c) * unit.
    Proof.
      intros H T. pose proof (unit_positive G sigma spread) as U.
      assert (One : 1 <= height) by (apply (IZR_le 1); exact high).
      replace (Sum 0 (M - 1) v / height - unit * total) with
        ((Sum 0 (M - 1) (fun j => v j - unit * profile j)
          + unit * (Sum 0 (M - 1) profile - height * total)) / height)
        by (rewrite Sum_minus, Sum_scale; field; lra).
      unfold Rdiv. rewrite Rabs_mult, (Rabs_right (/ height)) by (apply Rle_ge, Rlt_le, Rinv_0_lt_compat; lra).
      apply (Rmult_le_reg_r height); [lra|]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
      eapply Rle_trans; [apply Rabs_triang|].
      rewrite (Rabs_mult unit), (Rabs_right unit) by lra.
      assert (A : Rabs (Sum 0 (M - 1) (fun j => v j - unit * profile j)) <= height * (b * unit)).
      { eapply Rle_trans; [apply Sum_abs|].
        eapply Rle_trans; [apply (Sum_le _ _ _ (fun _ => b * unit)); intros; apply H; lia|].
        rewrite Sum_const by lia. replace (M - 1 - 0 + 1)%Z with M by lia. lra. }
      apply (Rmult_le_compat_l unit) in T; [|lra]. lra.
    Qed.

    Definition mean_square (f : Z -> radii -> R) : R :=
      Sum 0 (M - 1) (fun j => relative_variance L (f j)) / height.

    Lemma height_powers : 1 <= height /\ height <= height * height /\
      height * height <= height * (height * height).
    Proof.
      assert (One : 1 <= height) by (apply (IZR_le 1); exact high).
      assert (Two : 1 * height <= height * height) by (apply Rmult_le_compat_r; lra).
      assert (1 * (height * height) <= height * (height * height)) by (apply Rmult_le_compat_r; lra). lra.
    Qed.

    Theorem surface_average f : 0 < f ->
      (forall rho, carries M (X rho) (surface M f) (F rho)) ->
      let f1 j := surface_linear (across j) j (f / (2 * n_y G)) in
      (forall j, (0 <= j < M)%Z -> linearised (fun rho => f_plus (F rho) (across j) j) (f1 j)) /\
      Rabs (mean_square f1 - unit * (height * height * height)) <= 4 * (height * height) * unit.
    Proof.
      intros Hf C f1. pose proof height_powers as (One & Two & Three).
      assert (V : forall j, (0 <= j < M)%Z -> _) by
        (intros j Hj; exact (surface_variance (across j) j (proj1 (contacts j Hj)) (proj2 (contacts j Hj)) f Hf C)).
      split; [intros j Hj; apply (V j Hj)|].
      eapply Rle_trans; [apply (layers_counted _ (fun j => 2 * (IZR (M - j) * IZR (M - j)) * (2 * IZR j + height))
        (height * height * height) (2 * height ^ 2 + height) (height * height))|].
      - intros j Hj. apply (V j Hj).
      - rewrite (Sum_telescope (fun m => let n := IZR m + 1 in 
          2 * (height ^ 3 * n - height * n * (n - 1) * (2 * n - 1) / 2 + n ^ 2 * (n - 1) ^ 2 / 2)))
          by (lia || (intros; cbv zeta; rewrite !minus_IZR; field)).
        cbv zeta. rewrite !minus_IZR. apply Rabs_le. lra.
      - pose proof (unit_positive G sigma spread). apply Rmult_le_compat_r; lra.
    Qed.

    Theorem bulk_average g : 0 < g ->
      (forall rho, carries M (X rho) (bulk g) (F rho)) ->
      let f1 j := bulk_linear (across j) j (g / (2 * n_y G)) in
      (forall j, (0 <= j < M)%Z -> linearised (fun rho => f_plus (F rho) (across j) j) (f1 j)) /\
      Rabs (mean_square f1 - unit * (1 / 5 * (height * height * height))) <= 2 * (height * height) * unit.
    Proof.
      intros Hg C f1. pose proof height_powers as (One & Two & Three).
      assert (V : forall j, (0 <= j < M)%Z -> _) by
        (intros j Hj; exact (bulk_variance (across j) j (proj1 (contacts j Hj)) (proj2 (contacts j Hj)) g Hg C)).
      split; [intros j Hj; apply (V j Hj)|].
      eapply Rle_trans; [apply (layers_counted _ (fun j => 3 / 10 * (IZR (M - j) * IZR (M - j)) * (4 * IZR j + height))
        (1 / 5 * (height * height * height)) (3 / 8 * height ^ 2 + 5 / 4 * height) (3 / 20 * (height * height)))|].
      - intros j Hj. apply (V j Hj).
      - rewrite (Sum_telescope (fun m => let n := IZR m + 1 in 
          3 / 10 * (height ^ 3 * n + height ^ 2 * n * (n - 1) - 7 / 6 * height * n * (n - 1) * (2 * n - 1)
            + n ^ 2 * (n - 1) ^ 2)))
          by (lia || (intros; cbv zeta; rewrite !minus_IZR; field)).
        cbv zeta. rewrite !minus_IZR. apply Rabs_le. lra.
      - pose proof (unit_positive G sigma spread). apply Rmult_le_compat_r; lra.
    Qed.
  End Average.
End Variances.

(** ** Roots *)

(** A root beside another when the squares are near. *)
Lemma root_near s t b : 0 < t -> Rabs (s - t * t) <= b * (t * t) -> Rabs (sqrt s - t) <= b * t.
Proof.
  intros Ht H. apply Rabs_def2' in H.
  destruct (Rle_dec 0 s) as [Hs|Hs].
  - pose proof (sqrt_sqrt s Hs) as E. pose proof (sqrt_pos s) as Hq.
    apply Rabs_le. split.
    + apply (Rmult_le_reg_r t); [exact Ht|].
      destruct (Rle_dec (sqrt s) t) as [Hl|Hl].
      * assert (0 <= (t - sqrt s) * sqrt s) by (apply Rmult_le_pos; lra). lra.
      * assert (0 <= (sqrt s - t) * t) by (apply Rmult_le_pos; lra).
        assert (0 <= b * (t * t)) by (apply Rle_trans with (s - t * t); [rewrite <- E|lra];
          assert (0 <= (sqrt s - t) * sqrt s) by (apply Rmult_le_pos; lra); lra). lra.
    + apply (Rmult_le_reg_r t); [exact Ht|].
      destruct (Rle_dec t (sqrt s)) as [Hl|Hl].
      * assert (0 <= (sqrt s - t) * sqrt s) by (apply Rmult_le_pos; lra). lra.
      * assert (0 <= (t - sqrt s) * t) by (apply Rmult_le_pos; lra).
        assert (0 <= b * (t * t)) by (apply Rle_trans with (t * t - s); [rewrite <- E|lra];
          assert (0 <= (t - sqrt s) * sqrt s) by (apply Rmult_le_pos; lra); lra). lra.
  - rewrite sqrt_neg_0 by lra. rewrite Rminus_0_l, Rabs_Ropp, Rabs_right by lra.
    apply (Rmult_le_reg_r t); lra.
Qed.

(** The power 3/2, squared. *)
Lemma three_halves x : 0 < x -> root 2 x ^ 3 * root 2 x ^ 3 = x * x * x.
Proof.
  intros H. destruct (root_is 2 x ltac:(lia) H) as [_ E].
  transitivity (root 2 x ^ 2 * root 2 x ^ 2 * root 2 x ^ 2); [ring|]. rewrite E. reflexivity.
Qed.

(** An average of the order M³ in the unit, as a root: its constant depends on φ alone. *)
Theorem root_of_average G M sigma k b s : 0 < sigma -> (1 <= M)%Z -> 0 < k ->
  Rabs (s - unit_of G sigma * (k * (IZR M * IZR M * IZR M))) <= b * (IZR M * IZR M) * unit_of G sigma ->
  Rabs (sqrt s - sqrt k / (1 - phi G * phi G) * (root 2 (IZR M) ^ 3 * sigma / r G))
    <= b / k / IZR M * (sqrt k / (1 - phi G * phi G) * (root 2 (IZR M) ^ 3 * sigma / r G)).
Proof.
  intros Hs HM Hk H. pose proof (r_pos G). pose proof (divisor_positive G).
  assert (One : 1 <= IZR M) by (apply (IZR_le 1); exact HM).
  assert (Q : 0 < sqrt k) by (apply sqrt_lt_R0; exact Hk).
  assert (Pw : 0 < root 2 (IZR M) ^ 3) by (apply pow_lt, root_is; [lia|lra]).
  assert (T : sqrt k / (1 - phi G * phi G) * (root 2 (IZR M) ^ 3 * sigma / r G) *
    (sqrt k / (1 - phi G * phi G) * (root 2 (IZR M) ^ 3 * sigma / r G)) =
    unit_of G sigma * (k * (IZR M * IZR M * IZR M))).
  { transitivity ((sqrt k * sqrt k) * (root 2 (IZR M) ^ 3 * root 2 (IZR M) ^ 3) * unit_of G sigma).
    - unfold unit_of. field. lra.
    - rewrite sqrt_sqrt, three_halves by lra. ring. }
  apply root_near.
  - apply Rmult_lt_0_compat; apply Rdiv_lt_0_compat; try lra. apply Rmult_lt_0_compat; lra.
  - rewrite T. eapply Rle_trans; [exact H|]. apply Req_le. field. lra.
Qed.

Lemma constant_positive k x : 0 < k -> -(1 / 2) < x < 1 / 2 -> 0 < sqrt k / (1 - x * x).
Proof.
  intros Hk Hx. apply Rdiv_lt_0_compat; [apply sqrt_lt_R0, Hk|].
  destruct (Rle_dec 0 x).
  - assert (x * x <= 1 / 2 * (1 / 2)) by (apply Rmult_le_compat; lra). lra.
  - assert (- x * - x <= 1 / 2 * (1 / 2)) by (apply Rmult_le_compat; lra). lra.
Qed.

Lemma positive_power x n : 0 < x -> (n <> 0)%nat -> x ^ n = 1 -> x = 1.
Proof.
  intros Hx Hn H. destruct (Rtotal_order x 1) as [L|[E|L]]; [|exact E|].
  - assert (x ^ n < 1) by (apply pow_lt_1_compat; [lra|lia]). lra.
  - assert (1 < x ^ n) by (apply Rlt_pow_R1; [lra|lia]). lra.
Qed.

(** c m^(3/2) s is 1 at one height m, in proportion to s^(−2/3). *)
Theorem critical_height c s m : 0 < c -> 0 < s -> 0 < m ->
  (c * (root 2 m ^ 3 * s)) ^ 2 = 1 <-> m = / root 3 c ^ 2 * / root 3 s ^ 2.
Proof.
  intros Hc Hs Hm.
  destruct (root_is 2 m ltac:(lia) Hm) as [Pa Ea]. destruct (root_is 3 c ltac:(lia) Hc) as [Pu Eu].
  destruct (root_is 3 s ltac:(lia) Hs) as [Pv Ev].
  set (a := root 2 m) in *. set (u := root 3 c) in *. set (v := root 3 s) in *.
  assert (Px : 0 < u * a * v) by (repeat apply Rmult_lt_0_compat; assumption).
  replace ((c * (a ^ 3 * s)) ^ 2) with ((u * a * v) ^ 6) by (rewrite <- Eu, <- Ev; ring).
  rewrite <- Ea. split; intros H.
  - apply positive_power in H; [|exact Px|lia].
    replace a with (u * a * v * (/ u * / v)) by (field; lra). rewrite H. field. lra.
  - assert (E : (u * a * v) ^ 2 = 1).
    { replace ((u * a * v) ^ 2) with (a ^ 2 * (u ^ 2 * v ^ 2)) by ring. rewrite H. field. lra. }
    apply positive_power in E; [|exact Px|lia]. rewrite E. ring.
Qed.
