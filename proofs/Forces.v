(** Forces to first order: how a bead passes on what it carries. By induction downwards that gives the forces of
    every contact under the three loads, on which Eqs. 6-11 rest. *)

From Coq Require Import ZArith Reals Lia Lra Bool.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** ** One bead *)

(** a u + b v = s near 0, u and v independent at 0: a and b are differentiable; their slopes. *)
Lemma solved (a b ux uy vx vy sx sy : R -> R) u u' w w' v v' y y' s s' t t' :
  expands ux u u' -> expands uy w w' -> expands vx v v' -> expands vy y y' ->
  expands sx s s' -> expands sy t t' -> u * y - w * v <> 0 ->
  near (fun e => a e * ux e + b e * vx e = sx e /\ a e * uy e + b e * vy e = sy e) ->
  expands a ((s * y - t * v) / (u * y - w * v))
    (((s' * y + s * y' - (t' * v + t * v')) * (u * y - w * v)
      - (u' * y + u * y' - (w' * v + w * v')) * (s * y - t * v))
      / ((u * y - w * v) * (u * y - w * v))) /\
  expands b ((u * t - w * s) / (u * y - w * v))
    (((u' * t + u * t' - (w' * s + w * s')) * (u * y - w * v)
      - (u' * y + u * y' - (w' * v + w * v')) * (u * t - w * s))
      / ((u * y - w * v) * (u * y - w * v))).
Proof.
  intros Hux Huy Hvx Hvy Hsx Hsy Hd N.
  assert (D : expands (fun e => ux e * vy e - uy e * vx e) (u * y - w * v)
    (u' * y + u * y' - (w' * v + w * v'))) by (apply expands_minus; apply expands_mult; assumption).
  pose proof (near_both _ _ N (expands_near_nonzero _ _ _ D Hd)) as N'.
  split.
  - eapply expands_near.
    + apply expands_div; [exact Hd|apply expands_minus; apply expands_mult; eassumption|exact D].
    + eapply near_then; [exact N'|]. cbv beta. intros e [[E1 E2] Hn]. rewrite <- E1, <- E2.
      field. exact Hn.
  - eapply expands_near.
    + apply expands_div; [exact Hd|apply expands_minus; apply expands_mult; eassumption|exact D].
    + eapply near_then; [exact N'|]. cbv beta. intros e [[E1 E2] Hn]. rewrite <- E1, <- E2.
      field. exact Hn.
Qed.

(** a u + b v = 0 near 0, u and v independent at 0: a and b vanish near 0. *)
Lemma only_zero (a b ux uy vx vy : R -> R) u u' w w' v v' y y' :
  expands ux u u' -> expands uy w w' -> expands vx v v' -> expands vy y y' ->
  u * y - w * v <> 0 ->
  near (fun e => a e * ux e + b e * vx e = 0 /\ a e * uy e + b e * vy e = 0) ->
  near (fun e => a e = 0 /\ b e = 0).
Proof.
  intros Hux Huy Hvx Hvy Hd N.
  assert (D : expands (fun e => ux e * vy e - uy e * vx e) (u * y - w * v)
    (u' * y + u * y' - (w' * v + w * v'))) by (apply expands_minus; apply expands_mult; assumption).
  eapply near_then; [exact (near_both _ _ N (expands_near_nonzero _ _ _ D Hd))|].
  cbv beta. intros e [[E1 E2] Hn].
  split; apply (Rmult_eq_reg_l (ux e * vy e - uy e * vx e)); try exact Hn.
  - transitivity ((a e * ux e + b e * vx e) * vy e - (a e * uy e + b e * vy e) * vx e); [ring|].
    rewrite E1, E2. ring.
  - transitivity ((a e * uy e + b e * vy e) * ux e - (a e * ux e + b e * vx e) * uy e); [ring|].
    rewrite E1, E2. ring.
Qed.

Section Forces.
  Variable G : lattice.
  Variable M : Z.
  Variable rho : radii.
  Variable X : centres.
  Hypothesis P : packing G M rho X.
  Variable load : Z -> Z -> vector.
  Variable F : forces.
  Hypothesis C : carries M X load F.
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).
  Local Notation phi := (phi G).
  Local Notation nu_plus := (tilt_plus G rho).
  Local Notation nu_minus := (tilt_minus G rho).

  (** A contact force as a vector; above the surface there is none. *)
  Lemma push_plus i j v d : bead M i j -> expands (f_plus F i j) v d ->
    expands (fun e => x_of (scale (f_plus F i j e) (N_plus X i j e)))
      (v * n_x) (d * n_x - v * nu_plus i j / (2 * n_x)) /\
    expands (fun e => y_of (scale (f_plus F i j e) (N_plus X i j e)))
      (v * n_y) (d * n_y + v * nu_plus i j / (2 * n_y)).
  Proof.
    intros H E. pose proof (n_x_pos G). pose proof (n_y_pos G).
    destruct (Z.eq_dec j M) as [->|Hne].
    - assert (Z0 : forall e, f_plus F i M e = 0) by (intros e; apply (free_surface _ _ _ _ C)).
      destruct (expands_unique _ _ _ 0 0 E) as [-> ->].
      { eapply expands_near; [apply expands_const|]. apply near_always. intros e. rewrite Z0. ring. }
      split; (eapply expands_near; [eapply expands_to; [apply (expands_const 0)|ring|]|];
        [field; lra|apply near_always; intros e; unfold scale; cbn; rewrite Z0; ring]).
    - destruct (N_plus_expands G M rho X P i j ltac:(site)) as [Nx Ny].
      split; unfold scale; cbn [x_of y_of]; (eapply expands_to; [apply expands_mult; eassumption|ring|]);
        field; lra.
  Qed.

  Lemma push_minus i j v d : bead M i j -> expands (f_minus F i j) v d ->
    expands (fun e => x_of (scale (f_minus F i j e) (N_minus X i j e)))
      (- v * n_x) (- d * n_x + v * nu_minus i j / (2 * n_x)) /\
    expands (fun e => y_of (scale (f_minus F i j e) (N_minus X i j e)))
      (v * n_y) (d * n_y + v * nu_minus i j / (2 * n_y)).
  Proof.
    intros H E. pose proof (n_x_pos G). pose proof (n_y_pos G).
    destruct (Z.eq_dec j M) as [->|Hne].
    - assert (Z0 : forall e, f_minus F i M e = 0) by (intros e; apply (free_surface _ _ _ _ C)).
      destruct (expands_unique _ _ _ 0 0 E) as [-> ->].
      { eapply expands_near; [apply expands_const|]. apply near_always. intros e. rewrite Z0. ring. }
      split; (eapply expands_near; [eapply expands_to; [apply (expands_const 0)|ring|]|];
        [field; lra|apply near_always; intros e; unfold scale; cbn; rewrite Z0; ring]).
    - destruct (N_minus_expands G M rho X P i j ltac:(site)) as [Nx Ny].
      split; unfold scale; cbn [x_of y_of]; (eapply expands_to; [apply expands_mult; eassumption|ring|]);
        field; lra.
  Qed.

  (** What leaves a bead (i, j) whose load points downwards, in terms of what enters it. *)
  Theorem passes i j l v d w c : bead M i j -> (1 <= j)%Z -> load i j = downwards l ->
    expands (f_plus F i j) v d -> expands (f_minus F i j) w c ->
    let v' := v + l / (2 * n_y) in
    let w' := w + l / (2 * n_y) in
    expands (f_plus F (i - 1) (j - 1)) v'
      (d + (- (phi * v * nu_plus i j) + w * nu_minus i j
            + phi * v' * nu_plus (i - 1) (j - 1) - w' * nu_minus (i + 1) (j - 1)) / (1 - phi * phi)) /\
    expands (f_minus F (i + 1) (j - 1)) w'
      (c + (- (phi * w * nu_minus i j) + v * nu_plus i j
            + phi * w' * nu_minus (i + 1) (j - 1) - v' * nu_plus (i - 1) (j - 1)) / (1 - phi * phi)).
  Proof.
    intros H Hj Hl Hp Hm v' w'.
    pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    destruct (push_plus i j v d H Hp) as [Px Py]. destruct (push_minus i j w c H Hm) as [Mx My].
    destruct (N_plus_expands G M rho X P (i - 1) (j - 1) ltac:(site)) as [Ux Uy].
    destruct (N_minus_expands G M rho X P (i + 1) (j - 1) ltac:(site)) as [Vx Vy].
    pose proof (expands_plus _ _ _ _ _ _ Px Mx) as Sx.
    pose proof (expands_plus _ _ _ _ _ _ (expands_plus _ _ _ _ _ _ Py My) (expands_const l)) as Sy.
    destruct (solved (f_plus F (i - 1) (j - 1)) (f_minus F (i + 1) (j - 1))
      _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Ux Uy Vx Vy Sx Sy) as [A B].
    - intros E. assert (0 < n_x * n_y) by (apply Rmult_lt_0_compat; assumption). lra.
    - eapply near_then; [exact (balance _ _ _ _ C i j H Hj)|]. intros e E.
      unfold balanced in E. rewrite Hl in E.
      pose proof (f_equal x_of E) as E1. pose proof (f_equal y_of E) as E2.
      components in E1. components in E2. components. split; lra.
    - assert (Hxy : 0 < n_x * n_y) by (apply Rmult_lt_0_compat; assumption).
      rewrite one_minus_phi_squared, phi_is. unfold v', w'.
      split; (eapply expands_to; [eassumption|field; repeat split; lra|]).
      + field_simplify_eq; [ring [(n_y_squared G)]|repeat split; lra].
      + field_simplify_eq; [ring [(n_y_squared G)]|repeat split; lra].
  Qed.
End Forces.

(** ** The loads of the paper *)

Lemma zero_is_downwards : zero = downwards 0.
Proof. unfold zero, downwards. f_equal. ring. Qed.

(** Relative changes, over ε, of the forces under a surface load (Eq. 11 and its mirror image). *)
Section Changes.
  Variable G : lattice.
  Variable rho : radii.
  Local Notation phi := (phi G).
  Local Notation nu_plus := (tilt_plus G rho).
  Local Notation nu_minus := (tilt_minus G rho).

  Definition surface_plus (M i j : Z) : R :=
    (phi * nu_plus i j - nu_minus (i + M - j + 1)%Z (M - 1)%Z
     - Sum 1 (M - j - 1) (fun n => nu_minus (i + n + 1)%Z (j + n - 1)%Z - nu_minus (i + n)%Z (j + n)%Z))
    / (1 - phi * phi).
  Definition surface_minus (M i j : Z) : R :=
    (phi * nu_minus i j - nu_plus (i - M + j - 1)%Z (M - 1)%Z
     - Sum 1 (M - j - 1) (fun n => nu_plus (i - n - 1)%Z (j + n - 1)%Z - nu_plus (i - n)%Z (j + n)%Z))
    / (1 - phi * phi).

  Lemma surface_plus_top M i :
    surface_plus M i (M - 1) = (phi * nu_plus i (M - 1)%Z - nu_minus (i + 2)%Z (M - 1)%Z) / (1 - phi * phi).
  Proof.
    unfold surface_plus. rewrite Sum_empty by lia.
    replace (i + M - (M - 1) + 1)%Z with (i + 2)%Z by lia. rewrite Rminus_0_r. reflexivity.
  Qed.

  Lemma surface_minus_top M i :
    surface_minus M i (M - 1) = (phi * nu_minus i (M - 1)%Z - nu_plus (i - 2)%Z (M - 1)%Z) / (1 - phi * phi).
  Proof.
    unfold surface_minus. rewrite Sum_empty by lia.
    replace (i - M + (M - 1) - 1)%Z with (i - 2)%Z by lia. rewrite Rminus_0_r. reflexivity.
  Qed.

  Lemma surface_plus_step M i j : (j + 1 < M)%Z ->
    surface_plus M i j = surface_plus M (i + 1) (j + 1) +
      (- (phi * nu_plus (i + 1)%Z (j + 1)%Z) + nu_minus (i + 1)%Z (j + 1)%Z
       + phi * nu_plus i j - nu_minus (i + 2)%Z j) / (1 - phi * phi).
  Proof.
    intros H. pose proof (divisor_positive G). unfold surface_plus.
    rewrite (Sum_first 1 (M - j - 1)) by lia.
    replace (Sum (1 + 1) (M - j - 1) _) with (Sum 1 (M - (j + 1) - 1) (fun n =>
      nu_minus (i + 1 + n + 1)%Z (j + 1 + n - 1)%Z - nu_minus (i + 1 + n)%Z (j + 1 + n)%Z)).
    2:{ rewrite Sum_next. apply Sum_eq; [lia|lia|]. intros m Hm. same_sites. }
    replace (i + 1 + M - (j + 1) + 1)%Z with (i + M - j + 1)%Z by lia.
    replace (i + 1 + 1)%Z with (i + 2)%Z by lia. replace (j + 1 - 1)%Z with j by lia.
    field. lra.
  Qed.

  Lemma surface_minus_step M i j : (j + 1 < M)%Z ->
    surface_minus M i j = surface_minus M (i - 1) (j + 1) +
      (- (phi * nu_minus (i - 1)%Z (j + 1)%Z) + nu_plus (i - 1)%Z (j + 1)%Z
       + phi * nu_minus i j - nu_plus (i - 2)%Z j) / (1 - phi * phi).
  Proof.
    intros H. pose proof (divisor_positive G). unfold surface_minus.
    rewrite (Sum_first 1 (M - j - 1)) by lia.
    replace (Sum (1 + 1) (M - j - 1) _) with (Sum 1 (M - (j + 1) - 1) (fun n =>
      nu_plus (i - 1 - n - 1)%Z (j + 1 + n - 1)%Z - nu_plus (i - 1 - n)%Z (j + 1 + n)%Z)).
    2:{ rewrite Sum_next. apply Sum_eq; [lia|lia|]. intros m Hm. same_sites. }
    replace (i - 1 - M + (j + 1) - 1)%Z with (i - M + j - 1)%Z by lia.
    replace (i - 1 - 1)%Z with (i - 2)%Z by lia. replace (j + 1 - 1)%Z with j by lia.
    field. lra.
  Qed.
End Changes.

Section Loads.
  Variable G : lattice.
  Variable M : Z.
  Variable rho : radii.
  Variable X : centres.
  Hypothesis P : packing G M rho X.
  Variable F : forces.
  Local Notation n_y := (n_y G).

  (** [passes], read from the contact below: the bead above (i, j) along n⁺, and along n⁻. *)
  Lemma below_plus load i j l v d w c : carries M X load F -> contact M i j ->
    load (i + 1)%Z (j + 1)%Z = downwards l ->
    expands (f_plus F (i + 1) (j + 1)) v d -> expands (f_minus F (i + 1) (j + 1)) w c ->
    let v' := v + l / (2 * n_y) in
    let w' := w + l / (2 * n_y) in
    expands (f_plus F i j) v'
      (d + (- (phi G * v * tilt_plus G rho (i + 1) (j + 1)) + w * tilt_minus G rho (i + 1) (j + 1)
            + phi G * v' * tilt_plus G rho i j - w' * tilt_minus G rho (i + 2) j)
            / (1 - phi G * phi G)).
  Proof.
    intros C H Hl Hp Hm v' w'.
    destruct (passes G M rho X P load F C (i + 1) (j + 1) l v d w c) as [E _];
      try assumption; try site.
    replace (i + 1 - 1)%Z with i in E by lia. replace (j + 1 - 1)%Z with j in E by lia.
    replace (i + 1 + 1)%Z with (i + 2)%Z in E by lia. exact E.
  Qed.

  Lemma below_minus load i j l v d w c : carries M X load F -> contact M i j ->
    load (i - 1)%Z (j + 1)%Z = downwards l ->
    expands (f_plus F (i - 1) (j + 1)) v d -> expands (f_minus F (i - 1) (j + 1)) w c ->
    let v' := v + l / (2 * n_y) in
    let w' := w + l / (2 * n_y) in
    expands (f_minus F i j) w'
      (c + (- (phi G * w * tilt_minus G rho (i - 1) (j + 1)) + v * tilt_plus G rho (i - 1) (j + 1)
            + phi G * w' * tilt_minus G rho i j - v' * tilt_plus G rho (i - 2) j)
            / (1 - phi G * phi G)).
  Proof.
    intros C H Hl Hp Hm v' w'.
    destruct (passes G M rho X P load F C (i - 1) (j + 1) l v d w c) as [_ E];
      try assumption; try site.
    replace (i - 1 + 1)%Z with i in E by lia. replace (j + 1 - 1)%Z with j in E by lia.
    replace (i - 1 - 1)%Z with (i - 2)%Z in E by lia. exact E.
  Qed.

  Lemma at_surface load i : carries M X load F ->
    expands (f_plus F i M) 0 0 /\ expands (f_minus F i M) 0 0.
  Proof.
    intros C. split; (eapply expands_near; [apply (expands_const 0)|]; apply near_always; intros e;
      symmetry; apply (free_surface _ _ _ _ C)).
  Qed.

  (** What leaves a bead without load that f⁺ alone enters, over what enters it (Eq. 8). *)
  Theorem propagates load i j : carries M X load F -> contact M i j -> (1 <= j)%Z ->
    load i j = zero -> near (fun e => f_minus F i j e = 0 /\ f_plus F i j e <> 0) ->
    let turn := tilt_plus G rho (i - 1) (j - 1) - tilt_plus G rho i j in
    expands (fun e => f_plus F (i - 1) (j - 1) e / f_plus F i j e)
      1 (phi G / (1 - phi G * phi G) * turn) /\
    expands (fun e => f_minus F (i + 1) (j - 1) e / f_plus F i j e)
      0 (- (turn / (1 - phi G * phi G))).
  Proof.
    intros C H Hj Hl N turn.
    pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    assert (Hxy : 0 < n_x G * n_y) by (apply Rmult_lt_0_compat; assumption).
    destruct (N_plus_expands G M rho X P i j H) as [Sx Sy].
    destruct (N_plus_expands G M rho X P (i - 1) (j - 1) ltac:(site)) as [Ux Uy].
    destruct (N_minus_expands G M rho X P (i + 1) (j - 1) ltac:(site)) as [Vx Vy].
    destruct (solved (fun e => f_plus F (i - 1) (j - 1) e / f_plus F i j e)
      (fun e => f_minus F (i + 1) (j - 1) e / f_plus F i j e)
      _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Ux Uy Vx Vy Sx Sy) as [A B].
    - lra.
    - eapply near_then; [exact (near_both _ _ N (balance _ _ _ _ C i j ltac:(site) Hj))|].
      intros e [[E0 Hn] E]. unfold balanced in E. rewrite Hl, E0 in E.
      pose proof (f_equal x_of E) as E1. pose proof (f_equal y_of E) as E2.
      components in E1. components in E2.
      split; apply (Rmult_eq_reg_l (f_plus F i j e)); try exact Hn; field_simplify; try exact Hn; lra.
    - unfold turn. rewrite one_minus_phi_squared, phi_is.
      split; (eapply expands_to; [eassumption|field; repeat split; lra|]).
      + field_simplify_eq; [ring [(n_y_squared G)]|repeat split; lra].
      + field_simplify_eq; [ring [(n_y_squared G)]|repeat split; lra].
  Qed.

  (** A surface load f on every bead at j = M: Eq. 11 for all layers, downwards. *)
  Theorem surface_force f : carries M X (surface M f) F -> forall j, (j <= M - 1)%Z ->
    forall i, contact M i j ->
    expands (f_plus F i j) (f / (2 * n_y)) (f / (2 * n_y) * surface_plus G rho M i j) /\
    expands (f_minus F i j) (f / (2 * n_y)) (f / (2 * n_y) * surface_minus G rho M i j).
  Proof.
    intros C j Hj. pose proof (divisor_positive G) as Hd. pose proof (n_y_pos G) as Hy.
    pattern j. apply (down_from _ (M - 1)); [| |exact Hj]; clear j Hj.
    - intros i Hi. rewrite surface_plus_top, surface_minus_top.
      assert (L : forall k, surface M f k (M - 1 + 1)%Z = downwards f).
      { intros k. unfold surface. replace (M - 1 + 1 =? M)%Z with true by lia. reflexivity. }
      split.
      + destruct (at_surface _ (i + 1) C) as [Sp Sm].
        pose proof (below_plus _ i (M - 1) f 0 0 0 0 C Hi (L _)) as B.
        replace (M - 1 + 1)%Z with M in B by lia.
        eapply expands_to; [apply B; assumption|field; lra|field; lra].
      + destruct (at_surface _ (i - 1) C) as [Sp Sm].
        pose proof (below_minus _ i (M - 1) f 0 0 0 0 C Hi (L _)) as B.
        replace (M - 1 + 1)%Z with M in B by lia.
        eapply expands_to; [apply B; assumption|field; lra|field; lra].
    - intros j Hj IH i Hi. rewrite surface_plus_step, surface_minus_step by lia.
      assert (L : forall k, surface M f k (j + 1)%Z = downwards 0).
      { intros k. unfold surface. replace (j + 1 =? M)%Z with false by lia. apply zero_is_downwards. }
      split.
      + destruct (IH (i + 1)%Z ltac:(site)) as [Sp Sm].
        eapply expands_to; [exact (below_plus _ i j 0 _ _ _ _ C Hi (L _) Sp Sm)|field; lra|field; lra].
      + destruct (IH (i - 1)%Z ltac:(site)) as [Sp Sm].
        eapply expands_to; [exact (below_minus _ i j 0 _ _ _ _ C Hi (L _) Sp Sm)|field; lra|field; lra].
  Qed.

  (** A weight g on every bead: loads superpose; layer l acts as the surface of a height l. *)
  Theorem bulk_force g : carries M X (bulk g) F -> forall j, (j <= M - 1)%Z ->
    forall i, contact M i j ->
    expands (f_plus F i j) (IZR (M - j) * (g / (2 * n_y)))
      (g / (2 * n_y) * Sum (j + 1) M (fun l => surface_plus G rho l i j)) /\
    expands (f_minus F i j) (IZR (M - j) * (g / (2 * n_y)))
      (g / (2 * n_y) * Sum (j + 1) M (fun l => surface_minus G rho l i j)).
  Proof.
    intros C j Hj. pose proof (divisor_positive G) as Hd. pose proof (n_y_pos G) as Hy.
    pattern j. apply (down_from _ (M - 1)); [| |exact Hj]; clear j Hj.
    - intros i Hi. replace (M - 1 + 1)%Z with M by lia.
      rewrite !Sum_one, surface_plus_top, surface_minus_top.
      replace (M - (M - 1))%Z with 1%Z by lia.
      split.
      + destruct (at_surface _ (i + 1) C) as [Sp Sm].
        pose proof (below_plus _ i (M - 1) g 0 0 0 0 C Hi eq_refl) as B.
        replace (M - 1 + 1)%Z with M in B by lia.
        eapply expands_to; [apply B; assumption|field; lra|field; lra].
      + destruct (at_surface _ (i - 1) C) as [Sp Sm].
        pose proof (below_minus _ i (M - 1) g 0 0 0 0 C Hi eq_refl) as B.
        replace (M - 1 + 1)%Z with M in B by lia.
        eapply expands_to; [apply B; assumption|field; lra|field; lra].
    - intros j Hj IH i Hi.
      assert (E : IZR (M - j) = IZR (M - (j + 1)) + 1) by (rewrite !minus_IZR, plus_IZR; ring).
      rewrite E. rewrite !(Sum_first (j + 1) M) by lia.
      pose proof (surface_plus_top G rho (j + 1) i) as Tp.
      pose proof (surface_minus_top G rho (j + 1) i) as Tm.
      replace (j + 1 - 1)%Z with j in * by lia. rewrite Tp, Tm.
      split.
      + destruct (IH (i + 1)%Z ltac:(site)) as [Sp Sm].
        eapply expands_to; [exact (below_plus _ i j g _ _ _ _ C Hi eq_refl Sp Sm)|field; lra|].
        rewrite (Sum_eq (j + 1 + 1) M (j + 1 + 1) M (fun l => surface_plus G rho l i j) (fun l =>
          surface_plus G rho l (i + 1) (j + 1) + (- (phi G * tilt_plus G rho (i + 1)%Z (j + 1)%Z)
            + tilt_minus G rho (i + 1)%Z (j + 1)%Z
            + phi G * tilt_plus G rho i j - tilt_minus G rho (i + 2)%Z j) / (1 - phi G * phi G)));
          [|lia|lia|intros; apply surface_plus_step; lia].
        rewrite Sum_plus, Sum_const by lia.
        replace (M - (j + 1 + 1) + 1)%Z with (M - (j + 1))%Z by lia. field. lra.
      + destruct (IH (i - 1)%Z ltac:(site)) as [Sp Sm].
        eapply expands_to; [exact (below_minus _ i j g _ _ _ _ C Hi eq_refl Sp Sm)|field; lra|].
        rewrite (Sum_eq (j + 1 + 1) M (j + 1 + 1) M (fun l => surface_minus G rho l i j) (fun l =>
          surface_minus G rho l (i - 1) (j + 1) + (- (phi G * tilt_minus G rho (i - 1)%Z (j + 1)%Z)
            + tilt_plus G rho (i - 1)%Z (j + 1)%Z
            + phi G * tilt_minus G rho i j - tilt_plus G rho (i - 2)%Z j) / (1 - phi G * phi G)));
          [|lia|lia|intros; apply surface_minus_step; lia].
        rewrite Sum_plus, Sum_const by lia.
        replace (M - (j + 1 + 1) + 1)%Z with (M - (j + 1))%Z by lia. field. lra.
  Qed.

  (** A bead without load that nothing enters sends nothing on: exactly, near 0. *)
  Lemma silent load i j : carries M X load F -> bead M i j -> (1 <= j)%Z -> load i j = zero ->
    near (fun e => f_plus F i j e = 0 /\ f_minus F i j e = 0) ->
    near (fun e => f_plus F (i - 1) (j - 1) e = 0 /\ f_minus F (i + 1) (j - 1) e = 0).
  Proof.
    intros C H Hj Hl N.
    destruct (N_plus_expands G M rho X P (i - 1) (j - 1) ltac:(site)) as [Ux Uy].
    destruct (N_minus_expands G M rho X P (i + 1) (j - 1) ltac:(site)) as [Vx Vy].
    pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    apply (only_zero _ _ _ _ _ _ _ _ _ _ _ _ _ _ Ux Uy Vx Vy).
    - intros E. assert (0 < n_x G * n_y) by (apply Rmult_lt_0_compat; assumption). lra.
    - eapply near_then; [exact (near_both _ _ N (balance _ _ _ _ C i j H Hj))|].
      intros e [[E1 E2] E]. unfold balanced in E. rewrite Hl, E1, E2 in E.
      pose proof (f_equal x_of E) as Ex. pose proof (f_equal y_of E) as Ey.
      components in Ex. components in Ey. split; lra.
  Qed.

  Lemma nothing_above load l : carries M X load F -> (0 <= l)%Z ->
    (forall i j, (l < j <= M)%Z -> load i j = zero) ->
    forall j, (j <= M)%Z -> (l <= j)%Z -> forall i, bead M i j ->
    near (fun e => f_plus F i j e = 0 /\ f_minus F i j e = 0).
  Proof.
    intros C Hl0 Hl j Hj. pattern j. apply (down_from _ M); [| |exact Hj]; clear j Hj.
    - intros _ i Hi. apply near_always. intros e. apply (free_surface _ _ _ _ C).
    - intros j Hj IH Hlj i Hi.
      pose proof (silent load (i + 1) (j + 1) C ltac:(site) ltac:(lia) ltac:(apply Hl; lia)
        (IH ltac:(lia) (i + 1)%Z ltac:(site))) as A.
      pose proof (silent load (i - 1) (j + 1) C ltac:(site) ltac:(lia) ltac:(apply Hl; lia)
        (IH ltac:(lia) (i - 1)%Z ltac:(site))) as B.
      replace (i + 1 - 1)%Z with i in A by lia. replace (j + 1 - 1)%Z with j in * by lia.
      replace (i - 1 + 1)%Z with i in B by lia.
      eapply near_then; [exact (near_both _ _ A B)|]. cbv beta. tauto.
  Qed.

  (** A bead that carries nothing but its load (Eq. 6). *)
  Theorem loaded_bead load k l : carries M X load F -> bead M k l -> (1 <= l)%Z ->
    (forall i j, (l < j <= M)%Z -> load i j = zero) ->
    near (fun e => add (load k l)
      (add (scale (f_plus F (k - 1) (l - 1) e) (N_plus X (k - 1) (l - 1) e))
           (scale (f_minus F (k + 1) (l - 1) e) (N_minus X (k + 1) (l - 1) e))) = zero).
  Proof.
    intros C H Hl Ha.
    pose proof (nothing_above load l C ltac:(lia) Ha l ltac:(site) ltac:(lia) k H) as N.
    eapply near_then; [exact (near_both _ _ N (balance _ _ _ _ C k l H Hl))|].
    intros e [[E1 E2] E]. unfold balanced in E. rewrite E1, E2 in E. rewrite <- E.
    unfold minus, add, scale. components. f_equal; ring.
  Qed.

  Lemma zero_expands f : near (fun e => f e = 0) -> expands f 0 0.
  Proof.
    intros N. eapply expands_near; [apply (expands_const 0)|]. eapply near_then; [exact N|].
    intros e E. symmetry. exact E.
  Qed.
End Loads.

(** ** A load on one bead (k, l) *)

Section Single.
  Variable G : lattice.
  Variable M : Z.
  Variable rho : radii.
  Variable X : centres.
  Hypothesis P : packing G M rho X.
  Variable F : forces.
  Variable k l : Z.
  Variable f : R.
  Hypothesis loaded : bead M k l.
  Hypothesis lifted : (1 <= l)%Z.
  Hypothesis C : carries M X (single k l f) F.
  Local Notation n_y := (n_y G).
  Local Notation phi := (phi G).
  Local Notation nu_plus := (tilt_plus G rho).
  Local Notation nu_minus := (tilt_minus G rho).

  (** Layers between the contact and the bead at which a force turns into it. *)
  Definition turn_plus (i j : Z) : Z := ((l - j + (k - i)) / 2)%Z.
  Definition turn_minus (i j : Z) : Z := ((l - j - (k - i)) / 2)%Z.

  (** Ordered forces, and changes over ε, in units of f/2n_y: on a leg of the cone (n = l - j),
      inside of it (0 < n < l - j), outside. *)
  Definition ordered_plus (i j : Z) : R := if (k - i =? l - j)%Z then 1 else 0.
  Definition ordered_minus (i j : Z) : R := if (i - k =? l - j)%Z then 1 else 0.
  Definition response_plus (i j : Z) : R :=
    let n := turn_plus i j in
    if (k - i =? l - j)%Z then (phi * nu_plus i j - nu_minus (k + 1)%Z (l - 1)%Z) / (1 - phi * phi)
    else if ((1 <=? n) && (n <? l - j))%Z
      then - ((nu_minus (i + n + 1)%Z (j + n - 1)%Z - nu_minus (i + n)%Z (j + n)%Z) / (1 - phi * phi))
    else 0.
  Definition response_minus (i j : Z) : R :=
    let n := turn_minus i j in
    if (i - k =? l - j)%Z then (phi * nu_minus i j - nu_plus (k - 1)%Z (l - 1)%Z) / (1 - phi * phi)
    else if ((1 <=? n) && (n <? l - j))%Z
      then - ((nu_plus (i - n - 1)%Z (j + n - 1)%Z - nu_plus (i - n)%Z (j + n)%Z) / (1 - phi * phi))
    else 0.

  Lemma above_load j : (l <= j <= M)%Z -> forall i, bead M i j ->
    expands (f_plus F i j) 0 0 /\ expands (f_minus F i j) 0 0.
  Proof.
    intros Hj i Hi.
    pose proof (nothing_above G M rho X P F (single k l f) l C ltac:(lia)) as N.
    specialize (N ltac:(intros a b Hb; unfold single; replace (b =? l)%Z with false by lia;
      rewrite Bool.andb_false_r; reflexivity) j ltac:(lia) ltac:(lia) i Hi).
    split; apply zero_expands; (eapply near_then; [exact N|]); cbv beta; tauto.
  Qed.

  Lemma load_at i : single k l f i l = downwards (if (i =? k)%Z then f else 0).
  Proof.
    unfold single. rewrite Z.eqb_refl, Bool.andb_true_r.
    destruct (i =? k)%Z; [reflexivity|apply zero_is_downwards].
  Qed.

  Lemma no_load i j : j <> l -> single k l f i j = downwards 0.
  Proof.
    intros H. unfold single. replace (j =? l)%Z with false by lia.
    rewrite Bool.andb_false_r. apply zero_is_downwards.
  Qed.

  Ltac by_cases :=
    unfold ordered_plus, ordered_minus, response_plus, response_minus, turn_plus, turn_minus;
    cbv zeta;
    repeat match goal with
    | |- context [if ?b then _ else _] => let E := fresh "E" in destruct b eqn:E; try (exfalso; site)
    end;
    same_values; field; lra.

  Theorem single_force j : (j <= l - 1)%Z -> forall i, contact M i j ->
    expands (f_plus F i j) (f / (2 * n_y) * ordered_plus i j)
      (f / (2 * n_y) * response_plus i j) /\
    expands (f_minus F i j) (f / (2 * n_y) * ordered_minus i j)
      (f / (2 * n_y) * response_minus i j).
  Proof.
    intros Hj. pose proof (divisor_positive G) as Hd. pose proof (n_y_pos G) as Hy.
    pattern j. apply (down_from _ (l - 1)); [| |exact Hj]; clear j Hj.
    - intros i Hi. split.
      + destruct (above_load l ltac:(site) (i + 1) ltac:(site)) as [Sp Sm].
        pose proof (fun a => below_plus G M rho X P F _ i (l - 1) a 0 0 0 0 C Hi) as B.
        replace (l - 1 + 1)%Z with l in B by lia. specialize (B _ (load_at _) Sp Sm).
        eapply expands_to; [exact B|by_cases|by_cases].
      + destruct (above_load l ltac:(site) (i - 1) ltac:(site)) as [Sp Sm].
        pose proof (fun a => below_minus G M rho X P F _ i (l - 1) a 0 0 0 0 C Hi) as B.
        replace (l - 1 + 1)%Z with l in B by lia. specialize (B _ (load_at _) Sp Sm).
        eapply expands_to; [exact B|by_cases|by_cases].
    - intros j Hj IH i Hi. split.
      + destruct (IH (i + 1)%Z ltac:(site)) as [Sp Sm].
        pose proof (below_plus G M rho X P F _ i j 0 _ _ _ _ C Hi
          (no_load (i + 1) (j + 1) ltac:(lia)) Sp Sm) as B.
        eapply expands_to; [exact B|by_cases|by_cases].
      + destruct (IH (i - 1)%Z ltac:(site)) as [Sp Sm].
        pose proof (below_minus G M rho X P F _ i j 0 _ _ _ _ C Hi
          (no_load (i - 1) (j + 1) ltac:(lia)) Sp Sm) as B.
        eapply expands_to; [exact B|by_cases|by_cases].
  Qed.
End Single.
