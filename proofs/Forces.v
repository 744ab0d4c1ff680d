(** Forces to first order: how a bead passes on what it carries. By induction downwards that gives the forces of
    every contact under a load on one bead, and under loads of whole layers, on which Eqs. 6-11 rest. *)

From Coq Require Import ZArith Reals Lia Lra Bool.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry Mirror.

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
  split; (eapply expands_near;
    [apply expands_div; [exact Hd|apply expands_minus; apply expands_mult; eassumption|exact D]
    |eapply near_then; [exact N'|]; cbv beta; intros e [[E1 E2] Hn]; rewrite <- E1, <- E2; field; exact Hn]).
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
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Context (load : Z -> Z -> vector) (F : forces) (C : carries M X load F).
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

End Forces.

Lemma push_minus G M rho X (P : packing G M rho X) load F (C : carries M X load F) i j v d :
  bead M i j -> expands (f_minus F i j) v d ->
  expands (fun e => x_of (scale (f_minus F i j e) (N_minus X i j e)))
    (- v * n_x G) (- d * n_x G + v * tilt_minus G rho i j / (2 * n_x G)) /\
  expands (fun e => y_of (scale (f_minus F i j e) (N_minus X i j e)))
    (v * n_y G) (d * n_y G + v * tilt_minus G rho i j / (2 * n_y G)).
Proof.
  intros H E. rewrite f_minus_is in *. pose proof (n_x_pos G).
  destruct (push_plus G M _ _ (mirrored_packing G M rho X P) _ _
    (mirrored_carries M X load _ F C (fun _ _ => eq_refl)) (- i) j v d ltac:(site) E) as [Ex Ey].
  rewrite tilt_plus_mirrored, Z.opp_involutive in *.
  split; (eapply expands_near; [eapply expands_to|]);
    [exact (expands_opp _ _ _ Ex)|ring|field; lra| |exact Ey|reflexivity|reflexivity|];
    apply near_always; intros e; rewrite N_plus_mirrored; unfold flipped, scale; cbn [x_of y_of]; ring.
Qed.

(** ** From layer to layer *)

Lemma zero_is : zero = downwards 0.
Proof. unfold zero, downwards. f_equal. ring. Qed.

Section Below.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Context (load : Z -> Z -> vector) (F : forces) (C : carries M X load F).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).
  Local Notation phi := (phi G).
  Local Notation nu_plus := (tilt_plus G rho).
  Local Notation nu_minus := (tilt_minus G rho).

  (** What leaves the bead (i + 1, j + 1) along n⁺, in terms of what enters it, and of its load. *)
  Theorem f_plus_below i j g v d w c : contact M i j -> load (i + 1)%Z (j + 1)%Z = downwards g ->
    expands (f_plus F (i + 1) (j + 1)) v d -> expands (f_minus F (i + 1) (j + 1)) w c ->
    let a := g / (2 * n_y) in
    expands (f_plus F i j) (v + a)
      (d + (- (phi * v * nu_plus (i + 1)%Z (j + 1)%Z) + w * nu_minus (i + 1)%Z (j + 1)%Z
            + phi * (v + a) * nu_plus i j - (w + a) * nu_minus (i + 2)%Z j) / (1 - phi * phi)).
  Proof.
    intros H Hl Hp Hm a.
    pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    destruct (push_plus G M rho X P load F C (i + 1) (j + 1) v d ltac:(site) Hp) as [Px Py].
    destruct (push_minus G M rho X P load F C (i + 1) (j + 1) w c ltac:(site) Hm) as [Mx My].
    destruct (N_plus_expands G M rho X P i j H) as [Ux Uy].
    destruct (N_minus_expands G M rho X P (i + 2) j ltac:(site)) as [Vx Vy].
    pose proof (expands_plus _ _ _ _ _ _ Px Mx) as Sx.
    pose proof (expands_plus _ _ _ _ _ _ (expands_plus _ _ _ _ _ _ Py My) (expands_const g)) as Sy.
    assert (Hxy : 0 < n_x * n_y) by (apply Rmult_lt_0_compat; assumption).
    destruct (solved (f_plus F i j) (f_minus F (i + 2) j)
      _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Ux Uy Vx Vy Sx Sy) as [A _].
    - lra.
    - pose proof (balance _ _ _ _ C (i + 1)%Z (j + 1)%Z ltac:(site) ltac:(site)) as N.
      unfold balanced in N. rewrite Hl, !Z.add_simpl_r in N.
      replace (i + 1 + 1)%Z with (i + 2)%Z in N by lia.
      eapply near_then; [exact N|]. intros e E.
      pose proof (f_equal x_of E) as E1. pose proof (f_equal y_of E) as E2.
      components in E1. components in E2. components. split; lra.
    - unfold a. rewrite one_minus_phi_squared, phi_is.
      eapply expands_to; [exact A|field; repeat split; lra|].
      field_simplify_eq; [ring [(n_y_squared G)]|repeat split; lra].
  Qed.

  Lemma at_surface i : expands (f_plus F i M) 0 0 /\ expands (f_minus F i M) 0 0.
  Proof.
    split; (eapply expands_near; [apply (expands_const 0)|]; apply near_always; intros e;
      symmetry; apply (free_surface _ _ _ _ C)).
  Qed.
End Below.

(** ** Loads of whole layers *)

(** What turns into f⁺ at the beads above its contact, if f⁻ comes from a surface at height M. *)
Definition turned (G : lattice) (rho : radii) (M i j : Z) : R :=
  tilt_minus G rho (i + M - j + 1) (M - 1)
  + Sum 1 (M - j - 1) (fun n => tilt_minus G rho (i + n + 1) (j + n - 1) - tilt_minus G rho (i + n) (j + n)).

Lemma turned_at_top G rho i j : turned G rho (j + 1) i j = tilt_minus G rho (i + 2) j.
Proof.
  unfold turned. rewrite Sum_empty, Z.add_simpl_r by lia.
  replace (i + (j + 1) - j + 1)%Z with (i + 2)%Z by lia. ring.
Qed.

Lemma turned_below G rho M i j : (j + 1 < M)%Z -> turned G rho M i j =
  turned G rho M (i + 1) (j + 1) + (tilt_minus G rho (i + 2) j - tilt_minus G rho (i + 1) (j + 1)).
Proof.
  intros H. unfold turned. rewrite (Sum_first 1 (M - j - 1)), Sum_next by lia.
  rewrite (Sum_eq 1 (M - j - 1 - 1) 1 (M - (j + 1) - 1) _ (fun n =>
    tilt_minus G rho (i + 1 + n + 1) (j + 1 + n - 1) - tilt_minus G rho (i + 1 + n) (j + 1 + n)))
    by (lia || (intros; same_sites)).
  replace (i + 1 + M - (j + 1) + 1)%Z with (i + M - j + 1)%Z by lia.
  replace (i + 1 + 1)%Z with (i + 2)%Z by lia. rewrite Z.add_simpl_r. ring.
Qed.

(** The relative change of f⁺ over ε, where the load is at height M alone (Eq. 11); of f⁻. *)
Definition change_plus (G : lattice) (rho : radii) (M i j : Z) : R :=
  (phi G * tilt_plus G rho i j - turned G rho M i j) / (1 - phi G * phi G).
Definition change_minus (G : lattice) (rho : radii) (M i j : Z) : R :=
  change_plus G (mirrored rho) M (- i) j.

Lemma change_at_top G rho i j : change_plus G rho (j + 1) i j =
  (phi G * tilt_plus G rho i j - tilt_minus G rho (i + 2) j) / (1 - phi G * phi G).
Proof. unfold change_plus. rewrite turned_at_top. reflexivity. Qed.

(** A load g(l) on each bead of layer l: f⁺ of every contact. *)
Theorem layered_f_plus G M j : (j <= M)%Z -> forall rho X load F g,
  packing G M rho X -> carries M X load F -> (forall i l, load i l = downwards (g l)) ->
  forall i, bead M i j ->
  expands (f_plus F i j) (Sum (j + 1) M g / (2 * n_y G))
    (Sum (j + 1) M (fun l => g l * change_plus G rho l i j) / (2 * n_y G)).
Proof.
  intros Hj. pose proof (divisor_positive G) as Hd. pose proof (n_y_pos G) as Hy.
  pattern j. apply (down_from _ M); [| |exact Hj]; clear j Hj.
  - intros rho X load F g P C L i H. rewrite !Sum_empty by lia.
    eapply expands_to; [exact (proj1 (at_surface M X load F C i))|field; lra..].
  - intros j Hj IH rho X load F g P C L i H.
    pose proof (IH rho X load F g P C L (i + 1)%Z ltac:(site)) as Ep.
    assert (Em : exists c, expands (f_minus F (i + 1) (j + 1)) (Sum (j + 1 + 1) M g / (2 * n_y G)) c).
    { rewrite f_minus_is. eexists. apply (IH _ _ load _ g (mirrored_packing G M rho X P)); [|exact L|site].
      apply (mirrored_carries M X load _ F C). intros. rewrite !L, flipped_downwards. reflexivity. }
    destruct Em as [c Em].
    eapply expands_to; [exact (f_plus_below G M rho X P load F C i j _ _ _ _ _ ltac:(site) (L _ _) Ep Em)|..];
      rewrite !(Sum_first (j + 1) M) by lia; [field; lra|].
    rewrite (Sum_eq (j + 1 + 1) M (j + 1 + 1) M (fun l => g l * change_plus G rho l i j) (fun l =>
      g l * change_plus G rho l (i + 1) (j + 1)
      + g l * ((phi G * (tilt_plus G rho i j - tilt_plus G rho (i + 1) (j + 1))
          - (tilt_minus G rho (i + 2) j - tilt_minus G rho (i + 1) (j + 1))) / (1 - phi G * phi G))) eq_refl eq_refl)
      by (intros; unfold change_plus; rewrite turned_below by lia; field; lra).
    rewrite Sum_plus, Sum_times, change_at_top. field. lra.
Qed.

Lemma change_minus_is G rho M i j : change_minus G rho M i j =
  (phi G * tilt_minus G rho i j - (tilt_plus G rho (i - M + j - 1) (M - 1)
    + Sum 1 (M - j - 1) (fun n => tilt_plus G rho (i - n - 1) (j + n - 1) - tilt_plus G rho (i - n) (j + n))))
    / (1 - phi G * phi G).
Proof.
  unfold change_minus, change_plus, turned. rewrite tilt_plus_mirrored, tilt_minus_mirrored.
  rewrite Z.opp_involutive, (Sum_eq 1 (M - j - 1) 1 (M - j - 1) _ (fun n =>
    tilt_plus G rho (i - n - 1) (j + n - 1) - tilt_plus G rho (i - n) (j + n)) eq_refl eq_refl)
    by (intros; rewrite !tilt_minus_mirrored; same_values; reflexivity).
  replace (- (- i + M - j + 1))%Z with (i - M + j - 1)%Z by lia. reflexivity.
Qed.

Lemma surface_f_plus G M rho X F i j f : packing G M rho X -> carries M X (surface M f) F -> contact M i j ->
  expands (f_plus F i j) (f / (2 * n_y G)) (f / (2 * n_y G) * change_plus G rho M i j).
Proof.
  intros P C H. pose proof (n_y_pos G).
  assert (Top : forall h, Sum (j + 1) M (fun l => (if (l =? M)%Z then f else 0) * h l) = f * h M).
  { intros h. rewrite Sum_last, Z.eqb_refl, (Sum_zero (j + 1) (M - 1)); [ring| |site].
    intros l Hl. replace (l =? M)%Z with false by lia. ring. }
  eapply expands_to; [apply (layered_f_plus G M j ltac:(site) rho X _ F
    (fun l => if (l =? M)%Z then f else 0) P C); [|site]|..].
  - intros k l. unfold surface. destruct (l =? M)%Z; [reflexivity|apply zero_is].
  - rewrite <- (Rmult_1_r (Sum _ _ _)), <- Sum_times, Top, Rmult_1_r. reflexivity.
  - rewrite Top. field. lra.
Qed.

(** A load f on every bead of the surface: Eq. 11, and its mirror image. *)
Theorem surface_force G M rho X (P : packing G M rho X) F i j (H : contact M i j) f :
  carries M X (surface M f) F ->
  expands (f_plus F i j) (f / (2 * n_y G)) (f / (2 * n_y G) * change_plus G rho M i j) /\
  expands (f_minus F i j) (f / (2 * n_y G)) (f / (2 * n_y G) * change_minus G rho M i j).
Proof.
  intros C. split; [exact (surface_f_plus G M rho X F i j f P C H)|]. rewrite f_minus_is.
  apply (surface_f_plus G M _ (mirrored_centres X)); [exact (mirrored_packing G M rho X P)| |site].
  apply (mirrored_carries M X _ _ F C). intros k l. unfold surface.
  destruct (l =? M)%Z; rewrite ?zero_is; symmetry; apply flipped_downwards.
Qed.

(** A weight g on every bead: loads superpose; layer l acts as the surface of a height l. *)
Theorem bulk_force G M rho X (P : packing G M rho X) F i j (H : contact M i j) g :
  carries M X (bulk g) F ->
  expands (f_plus F i j) (IZR (M - j) * (g / (2 * n_y G)))
    (g / (2 * n_y G) * Sum (j + 1) M (fun l => change_plus G rho l i j)).
Proof.
  intros C. pose proof (n_y_pos G).
  eapply expands_to; [apply (layered_f_plus G M j ltac:(site) rho X _ F (fun _ => g) P C); [reflexivity|site]|..].
  - rewrite Sum_const by site. replace (M - (j + 1) + 1)%Z with (M - j)%Z by lia. field. lra.
  - rewrite Sum_scale. field. lra.
Qed.

(** ** Beads without load *)

Section Unloaded.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Variable F : forces.
  Local Notation n_y := (n_y G).

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
      steps_back in A. steps_back in *.
      steps_back in B.
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
End Unloaded.

(** The same, of f⁻ alone. *)
Corollary propagates_mirrored G M rho X (P : packing G M rho X) F load i j :
  carries M X load F -> contact M i j -> (1 <= j)%Z -> load i j = zero ->
  near (fun e => f_plus F i j e = 0 /\ f_minus F i j e <> 0) ->
  let turn := tilt_minus G rho (i + 1) (j - 1) - tilt_minus G rho i j in
  expands (fun e => f_minus F (i + 1) (j - 1) e / f_minus F i j e)
    1 (phi G / (1 - phi G * phi G) * turn) /\
  expands (fun e => f_plus F (i - 1) (j - 1) e / f_minus F i j e)
    0 (- (turn / (1 - phi G * phi G))).
Proof.
  intros C H Hj Hl N. pose proof (mirrored_carries M X load _ F C (fun _ _ => eq_refl)) as C'.
  pose proof (propagates G M _ _ (mirrored_packing G M rho X P) _ _ (- i) j C' ltac:(site) Hj) as E.
  cbn [f_plus f_minus mirrored_forces] in E. cbv zeta in *.
  rewrite !tilt_plus_mirrored, Z.opp_involutive in E. unfold mirrored in E.
  replace (- (- i - 1))%Z with (i + 1)%Z in E by lia. replace (- (- i + 1))%Z with (i - 1)%Z in E by lia.
  rewrite Z.opp_involutive in E. apply E; [rewrite Hl; unfold flipped, zero; components; f_equal; ring|exact N].
Qed.

(** ** A load on one bead (k, l) *)

(** Layers between the contact and the bead at which a force turns into it. *)
Definition turn_plus (k l i j : Z) : Z := ((l - j + (k - i)) / 2)%Z.

(** The ordered f⁺, and its change over ε, in units of f/2n_y: on a leg of the cone (n = l - j), inside of it
    (0 < n < l - j), outside. *)
Definition ordered_plus (k l i j : Z) : R := if (k - i =? l - j)%Z then 1 else 0.
Definition response_plus (G : lattice) (rho : radii) (k l i j : Z) : R :=
  let n := turn_plus k l i j in
  if (k - i =? l - j)%Z
  then (phi G * tilt_plus G rho i j - tilt_minus G rho (k + 1) (l - 1)) / (1 - phi G * phi G)
  else if ((1 <=? n) && (n <? l - j))%Z
  then - ((tilt_minus G rho (i + n + 1) (j + n - 1) - tilt_minus G rho (i + n) (j + n)) / (1 - phi G * phi G))
  else 0.

Lemma load_at k l f i : single k l f i l = downwards (if (i =? k)%Z then f else 0).
Proof.
  unfold single. rewrite Z.eqb_refl, Bool.andb_true_r.
  destruct (i =? k)%Z; [reflexivity|]. unfold downwards, zero. f_equal. ring.
Qed.

Lemma no_load k l f i j : j <> l -> single k l f i j = zero.
Proof. intros H. unfold single. replace (j =? l)%Z with false by lia. rewrite Bool.andb_false_r. reflexivity. Qed.

Lemma above_load G M rho X (P : packing G M rho X) F k l f (C : carries M X (single k l f) F) j :
  (0 <= l)%Z -> (l <= j <= M)%Z -> forall i, bead M i j ->
  expands (f_plus F i j) 0 0 /\ expands (f_minus F i j) 0 0.
Proof.
  intros Hl Hj i Hi.
  pose proof (nothing_above G M rho X P F (single k l f) l C Hl
    ltac:(intros; apply no_load; lia) j ltac:(lia) ltac:(lia) i Hi) as N.
  split; apply zero_expands; (eapply near_then; [exact N|]); cbv beta; tauto.
Qed.

Lemma mirrored_single k l f i j : single (- k) l f i j = flipped (single k l f (- i) j).
Proof.
  unfold single. replace (- i =? k)%Z with (i =? - k)%Z by lia.
  destruct ((i =? - k) && (j =? l))%bool%Z; unfold flipped, downwards, zero; components; f_equal; ring.
Qed.

Theorem single_f_plus G M l f j : (1 <= l)%Z -> (j <= l - 1)%Z -> forall rho X F k,
  packing G M rho X -> bead M k l -> carries M X (single k l f) F -> forall i, contact M i j ->
  expands (f_plus F i j) (f / (2 * n_y G) * ordered_plus k l i j) (f / (2 * n_y G) * response_plus G rho k l i j).
Proof.
  intros Hl Hj. pose proof (divisor_positive G) as Hd. pose proof (n_y_pos G) as Hy.
  pattern j. apply (down_from _ (l - 1)); [| |exact Hj]; clear j Hj.
  - intros rho X F k P K C i Hi.
    destruct (above_load G M rho X P F k l f C l ltac:(lia) ltac:(site) (i + 1) ltac:(site)) as [Sp Sm].
    pose proof (fun g => f_plus_below G M rho X P _ F C i (l - 1) g 0 0 0 0 Hi) as B.
    rewrite Z.sub_add, load_at in B.
    eapply expands_to; [exact (B _ eq_refl Sp Sm)|..];
      unfold ordered_plus, response_plus, turn_plus; cbv zeta; decide_conditions; same_values; field; lra.
  - intros j Hj IH rho X F k P K C i Hi.
    pose proof (IH rho X F k P K C (i + 1)%Z ltac:(site)) as Sp.
    assert (Sm : exists c, expands (f_minus F (i + 1) (j + 1))
      (f / (2 * n_y G) * ordered_plus (- k) l (- (i + 1)) (j + 1)) c).
    { rewrite f_minus_is. eexists. refine (IH _ _ _ _ (mirrored_packing G M rho X P) _
        (mirrored_carries M X _ _ F C (mirrored_single k l f)) _ _); site. }
    destruct Sm as [c Sm].
    pose proof (f_plus_below G M rho X P _ F C i j 0 _ _ _ _ Hi
      (eq_trans (no_load k l f (i + 1) (j + 1) ltac:(lia)) zero_is) Sp Sm) as B.
    eapply expands_to; [exact B|..];
      unfold ordered_plus, response_plus, turn_plus; cbv zeta; decide_conditions; same_values; field; lra.
Qed.

Definition ordered_minus (k l i j : Z) : R := ordered_plus (- k) l (- i) j.
Definition response_minus (G : lattice) (rho : radii) (k l i j : Z) : R :=
  response_plus G (mirrored rho) (- k) l (- i) j.

Theorem single_force G M rho X (P : packing G M rho X) F k l f (K : bead M k l) :
  (1 <= l)%Z -> carries M X (single k l f) F -> forall j, (j <= l - 1)%Z -> forall i, contact M i j ->
  expands (f_plus F i j) (f / (2 * n_y G) * ordered_plus k l i j)
    (f / (2 * n_y G) * response_plus G rho k l i j) /\
  expands (f_minus F i j) (f / (2 * n_y G) * ordered_minus k l i j)
    (f / (2 * n_y G) * response_minus G rho k l i j).
Proof.
  intros Hl C j Hj i Hi. split; [exact (single_f_plus G M l f j Hl Hj rho X F k P K C i Hi)|].
  rewrite f_minus_is. apply (single_f_plus G M l f j Hl Hj _ _ _ (- k) (mirrored_packing G M rho X P)
    ltac:(site) (mirrored_carries M X _ _ F C (mirrored_single k l f))). site.
Qed.
